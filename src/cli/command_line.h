// command_line.h: subcommands, their flags and their output files.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "base/json.h"

namespace pbnbrdf::cli {

// Runs what may find fault with the value of a flag. Throws UsageError in place of Error: with "--" before
// the message, which begins with the flag's name.
template <typename Function>
auto CheckFlags(Function function) {
  try {
    return function();
  } catch (const Error& error) {
    throw UsageError(StrCat("--", error.what()));
  }
}

using Arguments = std::vector<std::string>;

struct Command {
  std::string name;
  std::string summary;                            // one line
  std::string usage;                              // examples, a line each
  std::string notes;                              // more lines for --help, of any length
  Arguments arguments = {};                       // what the positional arguments are
  Fields flags = {};                              // of the options that the command owns
  std::function<int(const Arguments&)> run = {};  // returns the exit status

  // The command with options of its own, the table of their fields, and what to do with them.
  template <typename Options>
  Command With(Fields (*fields)(Options*), int (*function)(const Options&, const Arguments&)) && {
    const auto options = std::make_shared<Options>();
    flags = fields(options.get());
    run = [options, function](const Arguments& given) { return function(*options, given); };
    return std::move(*this);
  }
};

// Reads flags (Fields::ReadFlags) and "--flagfile=FILE", a file of such lines, into the command's options.
// Returns the positional arguments, as many as the command has. Throws UsageError, also if a value is out of
// range, a required flag is missing or a name is one of an earlier version: then it tells the new name.
Arguments ParseFlags(const Command& command, const Arguments& words);

// Throws UsageError if it is the name of a command of an earlier version.
void CheckOldCommand(std::string_view command);

struct Output {
  std::string flag;  // without "--"
  std::string path;  // "": not asked for
};

// To be called before the work. Throws UsageError if two flags name the same file, Error if one can't be
// written.
void CheckOutputs(const std::vector<Output>& outputs);

// Whether an output is standard output, which leaves no place there for what a command has to say.
bool UseStandardOutput(const std::vector<Output>& outputs);

// The subcommands, each in a file of its own.
Command CompareCommand();
Command EvalCommand();
Command ExportCommand();
Command FitCommand();
Command FitModelCommand();
Command InfoCommand();
Command MeasureCommand();
Command PlanCommand();
Command PriorCommand();

// With the render module only.
Command FitSceneCommand();
Command RenderCommand();
Command ReportCommand();

}  // namespace pbnbrdf::cli
