#include "old_names.h"

#include "command_line.h"

namespace pbnbrdf::cli {
namespace {

struct OldName {
  std::string_view command, flag, value;  // "": any
  std::string_view message;
};

constexpr OldName kOldNames[] = {
    {"tabulate", "", "", "tabulate is now export --format=merl"},
    {"values", "", "", "values is now eval"},
    {"eval", "fit", "", "eval --fit is now measure --fit"},
    {"measure", "eval_samples", "", "--eval_samples is now --samples"},
    {"measure", "eval_seed", "", "--eval_seed is now --seed"},
    {"fit", "model", "", "fit --model is now fit-model --model"},
    {"fit", "lobes", "", "fit --lobes is now fit-model --lobes"},
    {"fit", "scene", "", "fit --scene is now fit-scene --scene"},
    {"fit", "out_dir", "", "fit --out_dir is now fit-scene --out_dir"},
    {"", "solver", "tiny_lm", "--solver=tiny_lm is now --solver=lm"},
    {"", "solver", "lbfgs", "--solver=lbfgs is now --solver=ceres_lbfgs"},
    {"", "log_weight", "", "--log_weight=W is now --terms=log:W"},
    {"", "chromaticity_weight", "", "--chromaticity_weight=W is now --terms=log,chromaticity:W"},
    {"", "energy_weight", "", "--energy_weight=W is now --terms=log,energy:W"},
    {"", "jacobian", "autodiff", "--jacobian=autodiff is now --solver=autodiff"},
    {"", "jacobian", "condensed",
     "--jacobian=condensed is what all other solvers do: leave it out"},
};

bool IsOneOf(std::string_view name, std::string_view any_or) {
  return any_or.empty() || any_or == name;
}

}  // namespace

void CheckOldCommand(std::string_view command) {
  for (const OldName& old : kOldNames) {
    if (old.flag.empty() && old.command == command) throw UsageError(std::string(old.message));
  }
}

void CheckOldFlag(std::string_view command, std::string_view flag, std::string_view value) {
  for (const OldName& old : kOldNames) {
    if (old.flag == flag && IsOneOf(command, old.command) && IsOneOf(value, old.value)) {
      throw UsageError(std::string(old.message));
    }
  }
}

}  // namespace pbnbrdf::cli
