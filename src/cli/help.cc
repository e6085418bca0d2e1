#include "help.h"

#include <algorithm>
#include <sstream>

#include "base/text.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kFlagColumns = 24;     // "  --name" and blanks, before a flag's help
constexpr std::size_t kCommandColumns = 13;  // "  name" and blanks, before a command's summary

// Where the further lines of a line that is too long begin: below its second column, which follows two
// blanks or more ("  --seed    of the samples"), else below its first letter.
std::size_t Indent(const std::string& line) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t gap = line.find("  ", first);
  if (gap == std::string::npos) return first;
  const std::size_t second = line.find_first_not_of(' ', gap);
  return second < kColumns / 2 ? second : first;
}

// No line longer than kColumns, unless a word is.
std::string Wrapped(const std::string& text) {
  std::istringstream in(text);
  std::string wrapped;
  for (std::string line; std::getline(in, line);) {
    const std::size_t indent = Indent(line);
    while (line.size() > kColumns) {
      const std::size_t blank = line.rfind(' ', kColumns);
      if (blank == std::string::npos || blank <= indent) break;
      wrapped += line.substr(0, blank) + "\n";
      line = std::string(indent, ' ') + line.substr(blank + 1);
    }
    wrapped += line + "\n";
  }
  return wrapped;
}

std::string Padded(std::string text, std::size_t columns) {
  text.resize(std::max(columns, text.size() + 2), ' ');
  return text;
}

// "[60000]", what holds if the flag isn't given.
std::string DefaultText(const Field& flag) {
  if (flag.is_required) return " [required]";
  if (flag.is_switch) {
    return flag.default_text == "true" ? StrCat(" [on; --no", flag.name, ": off]") : "";
  }
  return flag.default_text.empty() ? "" : StrCat(" [", flag.default_text, "]");
}

std::string FlagsText(const Fields& flags, bool all) {
  std::string text, group;
  bool hides = false;
  for (const Field& flag : flags.all()) {
    if (!all && !flag.is_common) {
      hides = true;
      continue;
    }
    if (all && flag.group != group) text += "\n" + flag.group + ":\n";
    group = flag.group;
    text += Padded("  --" + flag.name, kFlagColumns) + flag.help + DefaultText(flag) + "\n";
  }
  if (hides) text += "\n--help=all shows all flags.";
  if (!flags.all().empty()) {
    text += StrCat(hides ? " " : "\n",
                   "--flagfile=FILE reads flags from a file, one a line; later flags replace "
                   "earlier ones.\n");
  }
  return text.empty() ? "" : "\n" + text;
}

}  // namespace

std::string OverviewText(std::span<const Command> commands) {
  std::string text =
      "pbnbrdf fits small neural BRDFs that obey physics to measured materials, by nonlinear least "
      "squares.\n\n"
      "  pbnbrdf fit --material=builtin:satin-gold --out=gold.safetensors\n"
      "  pbnbrdf measure --fit=gold.safetensors --material=builtin:satin-gold\n\n"
      "Commands:\n";
  for (const Command& command : commands) {
    text += Padded("  " + command.name, kCommandColumns) + command.summary + "\n";
  }
  return Wrapped(text +
                 "\npbnbrdf COMMAND --help explains a command; pbnbrdf --version prints the "
                 "version, --manual all of "
                 "the help as a page for man, --completion a script that makes bash complete.\n");
}

std::string HelpText(const Command& command, bool all) {
  std::string text = StrCat("pbnbrdf ", command.name, ": ", command.summary, "\n\n", command.usage,
                            FlagsText(command.flags, all));
  if (!command.notes.empty()) text += "\n" + command.notes;
  text += "\nExit status: 0 done, 1 bad input or output, 2 wrong usage.\n";
  return Wrapped(text);
}

}  // namespace pbnbrdf::cli
