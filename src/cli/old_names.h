// old_names.h: what earlier versions called things: using such a name is an error that tells the new one.
#pragma once

#include <string_view>

namespace pbnbrdf::cli {

// Throw UsageError if it is a name of an earlier version, and nothing else now.
void CheckOldCommand(std::string_view command);
void CheckOldFlag(std::string_view command, std::string_view flag, std::string_view value);

}  // namespace pbnbrdf::cli
