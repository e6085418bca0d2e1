// The manual page, from the same tables as --help.
#include <sstream>

#include "help.h"

namespace pbnbrdf::cli {
namespace {

// troff takes a backslash for a command, a hyphen for one where words break, and a point or a quote at the beginning
// of a line for a request.
std::string Escaped(const std::string& text) {
  std::string escaped;
  bool starts_line = true;
  for (const char c : text) {
    if (starts_line && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    starts_line = c == '\n';
  }
  return escaped;
}

// As it stands, line by line.
std::string Verbatim(const std::string& text) {
  if (text.empty()) return "";
  return StrCat(".PP\n.nf\n", Escaped(text), text.ends_with('\n') ? "" : "\n", ".fi\n");
}

std::string FlagText(const Field& flag) {
  std::string text = StrCat(".TP\n\\fB", Escaped("--" + flag.name), "\\fR");
  if (!flag.is_switch) text += "=\\fIVALUE\\fR";
  text += StrCat("\n", Escaped(flag.help));
  if (flag.is_required) {
    text += " [required]";
  } else if (!flag.default_text.empty() && flag.default_text != "false") {
    text += Escaped(StrCat(" [", flag.default_text, "]"));
  }
  return text + "\n";
}

std::string CommandText(const Command& command) {
  std::string text = StrCat(".SS ", Escaped(command.name), "\n", Escaped(command.summary), "\n",
                            Verbatim(command.usage));
  std::string group;
  for (const Field& flag : command.flags.all()) {
    if (flag.group != group) text += StrCat(".PP\n\\fI", Escaped(flag.group), "\\fR\n");
    group = flag.group;
    text += FlagText(flag);
  }
  return text + Verbatim(command.notes);
}

}  // namespace

std::string ManualPage(std::span<const Command> commands) {
  std::string text = StrCat(
      ".TH PBNBRDF 1 \"\" \"pbnbrdf ", PBNBRDF_VERSION, "\" \"User Commands\"\n",
      ".SH NAME\npbnbrdf \\- fits small neural BRDFs that obey physics to measured materials\n",
      ".SH SYNOPSIS\n.B pbnbrdf\n.I COMMAND\n[\\fIFLAG\\fR ...]\n.SH DESCRIPTION\n");
  text += Verbatim(OverviewText(commands));
  text += ".SH COMMANDS\n";
  text += Escaped(
      "Each takes --flagfile=FILE, which reads flags from a file, one a line. "
      "Later flags replace earlier ones.\n");
  for (const Command& command : commands) text += CommandText(command);
  return text + ".SH EXIT STATUS\n0 done, 1 bad input or output, 2 wrong usage.\n";
}

}  // namespace pbnbrdf::cli
