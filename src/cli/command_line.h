// command_line.h: subcommands, and the parser of their flags.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf::cli {

// The command line itself is at fault: exit status 2 instead of 1.
class UsageError : public Error {
 public:
  using Error::Error;
};

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
  std::string summary;                       // one line
  std::string usage;                         // examples, a line each
  std::string notes;                         // more lines for --help, of any length
  Arguments arguments;                       // what the positional arguments are
  Fields flags;                              // of the options that the command owns
  std::function<int(const Arguments&)> run;  // returns the exit status

  // Gives the command options of its own, the table of their fields, and what to do with them.
  template <typename Options>
  void Takes(Fields (*fields)(Options*), int (*function)(const Options&, const Arguments&)) {
    const auto options = std::make_shared<Options>();
    flags = fields(options.get());
    run = [options, function](const Arguments& given) { return function(*options, given); };
  }
};

// Reads "--name=value", "--name value", "--switch", "--noswitch" and "--flagfile=FILE" (lines of the same,
// # for comments; later settings replace earlier ones) into the command's options. Returns the positional
// arguments, as many as the command has. Throws UsageError, also if a value is out of range or a required
// flag is missing.
Arguments ParseFlags(const Command& command, const Arguments& arguments);

}  // namespace pbnbrdf::cli
