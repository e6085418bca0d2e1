#include "command_line.h"

#include "base/text.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {
namespace {

constexpr int kMaxFlagfileDepth = 8;  // of flagfiles that name flagfiles: ends a circle of them
constexpr std::uintmax_t kMaxFlagfileSize = 1 << 20;  // bytes; a flagfile has a few dozen lines

// What earlier versions called things.
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

void CheckOldFlag(std::string_view command, std::string_view flag, std::string_view value) {
  for (const OldName& old : kOldNames) {
    if (old.flag == flag && IsOneOf(command, old.command) && IsOneOf(value, old.value)) {
      throw UsageError(std::string(old.message));
    }
  }
}

// depth: of the flagfile that the words come from.
Arguments ReadWords(const Command& command, const Arguments& words, int depth);

void ReadFlagfile(const Command& command, const std::string& path, int depth) {
  if (depth > kMaxFlagfileDepth) throw UsageError(path + ": flagfiles are nested too deep");
  const std::string lines = ReadFile(path, kMaxFlagfileSize);
  try {
    for (const std::string& line : Split(lines, '\n')) {
      if (line.empty() || line.starts_with("#") || ReadWords(command, {line}, depth).empty())
        continue;
      throw UsageError(StrCat("'", line, "' is not a flag"));
    }
  } catch (const UsageError& error) {
    throw UsageError(StrCat(path, ": ", error.what()));
  }
}

Arguments ReadWords(const Command& command, const Arguments& words, int depth) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    const FlagText flag(*word);
    const std::string next = word + 1 == words.end() ? "" : word[1];
    if (word->starts_with("-")) CheckOldFlag(command.name, flag.name, flag.value.value_or(next));
  }
  Fields flags = command.flags;
  if (!flags.all().empty()) {
    flags.Add(Custom(
        "flagfile",
        [&](std::string_view path) { ReadFlagfile(command, std::string(path), depth + 1); },
        [] { return ""; }, [] {}, ""));
  }
  return flags.ReadFlags(words);
}

}  // namespace

void CheckOldCommand(std::string_view command) {
  for (const OldName& old : kOldNames) {
    if (old.flag.empty() && old.command == command) throw UsageError(std::string(old.message));
  }
}

Arguments ParseFlags(const Command& command, const Arguments& words) try {
  const Arguments arguments = ReadWords(command, words, 0);
  CheckFlags([&] {
    command.flags.CheckRequired();
    command.flags.Check();
  });
  const std::size_t wanted = command.arguments.size();
  if (arguments.size() > wanted) {
    throw UsageError(StrCat("'", arguments[wanted], "' is not a flag; flags begin with --"));
  }
  if (arguments.size() < wanted) {
    throw UsageError(command.arguments[arguments.size()] + " is missing");
  }
  return arguments;
} catch (const UsageError& error) {
  throw UsageError(StrCat(error.what(), " (see pbnbrdf ", command.name, " --help)"));
}

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

bool UseStandardOutput(const std::vector<Output>& outputs) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const Output& output) { return output.path == "-"; });
}

}  // namespace pbnbrdf::cli
