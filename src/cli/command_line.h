// command_line.h: subcommands, their flags and their help.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf::cli {

// The command line itself is at fault: exit status 2 instead of 1.
class UsageError : public Error {
 public:
  using Error::Error;
};

struct FlagGroup {
  std::string title;  // "" for the first group
  std::vector<std::string> names;
};

struct Command {
  std::string name;
  std::string summary;                 // one line
  std::string usage;                   // examples, a line each
  std::string notes;                   // more lines for --help
  std::vector<FlagGroup> flags;        // those of gflags' that belong to it
  std::vector<std::string> arguments;  // what the positional arguments are
  int (*run)(const std::vector<std::string>& arguments);
};

// Reads "--name=value", "--name value", "--switch", "--noswitch" and "--flagfile=FILE" (lines of
// the same, # for comments; later settings replace earlier ones) into gflags' flags. Returns the
// positional arguments, as many as the command has. Throws UsageError.
std::vector<std::string> ParseFlags(const Command& command,
                                    const std::vector<std::string>& arguments);

std::string HelpText(const Command& command);

// "--name=value" for each flag that gflags holds, of those named.
std::vector<std::string> FlagLines(const std::vector<std::string>& names);

// Whether the command line, or a flagfile, has set the flag to anything but its default.
bool IsGiven(const std::string& name);

// Throws UsageError "--name is required" if the flag's value is empty.
void RequireFlag(const std::string& name, const std::string& value);

}  // namespace pbnbrdf::cli
