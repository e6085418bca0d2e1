#include "outputs.h"

#include <nlohmann/json.hpp>

#include "command_line.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {

void CheckOutputs(const std::vector<Output>& outputs) {
  for (auto a = outputs.begin(); a != outputs.end(); ++a) {
    if (a->path.empty()) continue;
    for (auto b = outputs.begin(); b != a; ++b) {
      if (a->path == b->path) {
        throw UsageError(StrCat("--", b->flag, " and --", a->flag, " name the same file"));
      }
    }
  }
  for (const Output& output : outputs) {
    if (!output.path.empty()) CheckWritable(output.path);
  }
}

std::string JsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace pbnbrdf::cli
