// shared_flags.h: flags that more than one subcommand has.
#pragma once

#include <gflags/gflags_declare.h>

#include "pbnbrdf/base/error.h"

DECLARE_string(material);
DECLARE_string(out);

namespace pbnbrdf::cli {

// Runs what may find fault with the material, and puts its name before the message.
template <typename Function>
auto AboutMaterial(Function function) {
  try {
    return function();
  } catch (const Error& error) {
    Fail(FLAGS_material, ": ", error.what());
  }
}

}  // namespace pbnbrdf::cli
