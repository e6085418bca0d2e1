// outputs.h: the files that a command writes.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace pbnbrdf::cli {

struct Output {
  std::string flag;  // without "--"
  std::string path;  // "": not asked for
};

// To be called before the work. Throws UsageError if two flags name the same file, Error if one can't be
// written.
void CheckOutputs(const std::vector<Output>& outputs);

// As a file has it: indented, whatever bytes its texts have.
std::string JsonText(const nlohmann::ordered_json& json);

}  // namespace pbnbrdf::cli
