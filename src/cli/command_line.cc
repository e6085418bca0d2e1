#include "command_line.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {
namespace {

constexpr int kDeepestFlagfile = 8;
constexpr std::uintmax_t kLargestFlagfile = 1 << 20;

template <typename... Parts>
[[noreturn]] void FailUsage(const Parts&... parts) {
  throw UsageError(StrCat(parts...));
}

// A flag's value as its user would write it: gflags shows doubles with all 17 digits.
std::string ShownValue(const std::string& type, const std::string& value) {
  return type == "double" ? FormatNumber(ParseNumber("flag", value)) : value;
}

std::vector<std::string> AllFlags(const Command& command) {
  std::vector<std::string> names;
  for (const FlagGroup& group : command.flags) {
    names.insert(names.end(), group.names.begin(), group.names.end());
  }
  return names;
}

class Parser {
 public:
  explicit Parser(const Command& command) : command_(command), flags_(AllFlags(command)) {}

  void Parse(const std::vector<std::string>& arguments, int depth) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const std::string& text = arguments[i];
      if (!text.starts_with("-") || text == "-") {
        TakeArgument(text);
        continue;
      }
      std::string name = text.substr(text.starts_with("--") ? 2 : 1);
      std::string value;
      const std::size_t equals = name.find('=');
      if (equals != std::string::npos) {
        value = name.substr(equals + 1);
        name.resize(equals);
      } else if (IsSwitch(name)) {
        value = "true";
      } else if (name.starts_with("no") && IsSwitch(name.substr(2))) {
        name = name.substr(2);
        value = "false";
      } else if (IsKnown(name) && i + 1 < arguments.size()) {
        value = arguments[++i];
      } else if (IsKnown(name)) {
        FailUsage("--", name, " needs a value");
      }
      Set(name, value, depth);
    }
  }

  const std::vector<std::string>& arguments() const { return arguments_; }

 private:
  bool IsKnown(const std::string& name) const {
    return name == "flagfile" || std::count(flags_.begin(), flags_.end(), name) > 0;
  }

  bool IsSwitch(const std::string& name) const {
    gflags::CommandLineFlagInfo info;
    return IsKnown(name) && gflags::GetCommandLineFlagInfo(name.c_str(), &info) &&
           info.type == "bool";
  }

  void TakeArgument(const std::string& text) {
    if (arguments_.size() == command_.arguments.size()) {
      FailUsage("'", text, "' is not a flag; flags begin with --");
    }
    arguments_.push_back(text);
  }

  void Set(const std::string& name, const std::string& value, int depth) {
    if (name == "flagfile") return ReadFlagfile(value, depth);
    if (!IsKnown(name)) {
      FailUsage("--", name, " is not a flag of '", command_.name, "'; did you mean --",
                Nearest(flags_, name), "? See pbnbrdf ", command_.name, " --help");
    }
    if (gflags::SetCommandLineOption(name.c_str(), value.c_str()).empty()) {
      gflags::CommandLineFlagInfo info;
      gflags::GetCommandLineFlagInfo(name.c_str(), &info);
      FailUsage("--", name, "=", value, " is not a ", info.type, " value");
    }
  }

  void ReadFlagfile(const std::string& path, int depth) {
    if (depth >= kDeepestFlagfile) FailUsage(path, ": flagfiles are nested too deep");
    std::istringstream in(ReadFile(path, kLargestFlagfile));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
      const std::string text(Trim(line));
      if (text.empty() || text.starts_with("#")) continue;
      if (!text.starts_with("-")) FailUsage(path, ": '", text, "' is not a flag");
      lines.push_back(text);
    }
    try {
      Parse(lines, depth + 1);
    } catch (const UsageError& error) {
      FailUsage(path, ": ", error.what());
    }
  }

  const Command& command_;
  const std::vector<std::string> flags_;
  std::vector<std::string> arguments_;
};

}  // namespace

std::vector<std::string> ParseFlags(const Command& command,
                                    const std::vector<std::string>& arguments) {
  Parser parser(command);
  parser.Parse(arguments, 0);
  const std::size_t given = parser.arguments().size();
  if (given < command.arguments.size()) FailUsage(command.arguments[given], " is missing");
  return parser.arguments();
}

std::string HelpText(const Command& command) {
  std::ostringstream help;
  help << "pbnbrdf " << command.name << ": " << command.summary << "\n\n" << command.usage;
  for (const FlagGroup& group : command.flags) {
    help << "\n" << group.title << (group.title.empty() ? "" : ":\n");
    for (const std::string& name : group.names) {
      gflags::CommandLineFlagInfo info;
      gflags::GetCommandLineFlagInfo(name.c_str(), &info);
      help << "  --" << std::left << std::setw(20) << name << " " << info.description;
      if (!info.default_value.empty() && info.type != "bool") {
        help << " [" << ShownValue(info.type, info.default_value) << "]";
      }
      help << "\n";
    }
  }
  if (!command.flags.empty()) {
    help << "\n--flagfile=FILE reads flags from a file, one a line; later flags replace earlier "
            "ones.\n";
  }
  if (!command.notes.empty()) help << "\n" << command.notes;
  help << "\nExit status: 0 done, 1 bad input or output, 2 wrong usage.\n";
  return help.str();
}

std::vector<std::string> FlagLines(const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    gflags::CommandLineFlagInfo info;
    if (gflags::GetCommandLineFlagInfo(name.c_str(), &info)) {
      lines.push_back(StrCat("--", name, "=", ShownValue(info.type, info.current_value)));
    }
  }
  return lines;
}

bool IsGiven(const std::string& name) {
  gflags::CommandLineFlagInfo info;
  return gflags::GetCommandLineFlagInfo(name.c_str(), &info) && !info.is_default;
}

void RequireFlag(const std::string& name, const std::string& value) {
  if (value.empty()) FailUsage("--", name, " is required");
}

}  // namespace pbnbrdf::cli
