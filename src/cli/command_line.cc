#include "command_line.h"

#include <sstream>

#include "base/text.h"
#include "old_names.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {
namespace {

constexpr int kMaxFlagfileDepth = 8;  // of flagfiles that name flagfiles: ends a circle of them
constexpr std::uintmax_t kMaxFlagfileSize = 1 << 20;  // bytes; a flagfile has a few dozen lines

template <typename... Parts>
[[noreturn]] void FailUsage(const Parts&... parts) {
  throw UsageError(StrCat(parts...));
}

class Parser {
 public:
  explicit Parser(const Command& command) : command_(command) {}

  // depth: of the flagfile that the arguments come from.
  void Parse(const Arguments& arguments, int depth) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      if (!arguments[i].starts_with("-") || arguments[i] == "-") {
        TakeArgument(arguments[i]);
        continue;
      }
      FlagText flag(arguments[i]);
      CheckOldFlag(command_.name, flag.name, flag.value.value_or(""));
      if (!flag.value && command_.flags.SetSwitch(flag.name)) continue;
      const bool is_flagfile = flag.name == "flagfile";
      if (!is_flagfile && command_.flags.Find(flag.name) == nullptr) FailUnknown(flag.name);
      if (!flag.value) {
        if (i + 1 == arguments.size()) FailUsage("--", flag.name, " needs a value");
        flag.value = arguments[++i];
        CheckOldFlag(command_.name, flag.name, *flag.value);
      }
      if (is_flagfile) {
        ReadFlagfile(*flag.value, depth);
      } else {
        CheckFlags([&] { command_.flags.Set(flag.name, *flag.value); });
      }
    }
  }

  const Arguments& arguments() const { return arguments_; }

 private:
  void TakeArgument(const std::string& text) {
    if (arguments_.size() == command_.arguments.size()) {
      FailUsage("'", text, "' is not a flag; flags begin with --");
    }
    arguments_.push_back(text);
  }

  [[noreturn]] void FailUnknown(const std::string& name) const {
    const bool has_flags = !command_.flags.all().empty();
    FailUsage("--", name, " is not a flag of '", command_.name, "'",
              has_flags ? "; did you mean --" + command_.flags.NearestName(name) + "?" : ".",
              " See pbnbrdf ", command_.name, " --help");
  }

  void ReadFlagfile(const std::string& path, int depth) {
    if (depth >= kMaxFlagfileDepth) FailUsage(path, ": flagfiles are nested too deep");
    std::istringstream in(ReadFile(path, kMaxFlagfileSize));
    Arguments lines;
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
  Arguments arguments_;
};

}  // namespace

Arguments ParseFlags(const Command& command, const Arguments& arguments) {
  Parser parser(command);
  parser.Parse(arguments, 0);
  CheckFlags([&] {
    command.flags.CheckRequired();
    command.flags.Check();
  });
  const std::size_t given = parser.arguments().size();
  if (given < command.arguments.size()) FailUsage(command.arguments[given], " is missing");
  return parser.arguments();
}

}  // namespace pbnbrdf::cli
