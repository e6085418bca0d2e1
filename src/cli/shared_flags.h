// shared_flags.h: flags that more than one subcommand has.
#pragma once

#include <gflags/gflags_declare.h>

DECLARE_string(material);
DECLARE_string(out);
DECLARE_int32(threads);
