// pbnbrdf: the command line. Finds the subcommand, runs it and turns exceptions into one line.
#include <glog/logging.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <span>
#include <sstream>

#include "base/text.h"
#include "command_line.h"
#include "pbnbrdf/base/files.h"

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
  return Wrapped(
      text +
      "\npbnbrdf COMMAND --help explains a command; pbnbrdf --version prints the version.\n");
}

// How to use one command. all: with every flag, not only those that people use.
std::string HelpText(const Command& command, bool all) {
  std::string text = StrCat("pbnbrdf ", command.name, ": ", command.summary, "\n\n", command.usage,
                            FlagsText(command.flags, all));
  if (!command.notes.empty()) text += "\n" + command.notes;
  text += "\nExit status: 0 done, 1 bad input or output, 2 wrong usage.\n";
  return Wrapped(text);
}

// In the order in which people need them.
std::vector<Command> Commands() {
  return {FitCommand(),     MeasureCommand(), InfoCommand(),     EvalCommand(), ExportCommand(),
#ifdef PBNBRDF_HAS_RENDER
          ReportCommand(),  RenderCommand(),  FitSceneCommand(),
#endif
          CompareCommand(), FitModelCommand()};
}

// Whether the arguments ask for help; `all` if for all of it.
bool AsksForHelp(const Arguments& arguments, bool* all) {
  for (const std::string& argument : arguments) {
    *all = argument == "--help=all";
    if (*all || argument == "--help" || argument == "-h") return true;
  }
  return false;
}

int RunCommand(const Command& command, const Arguments& arguments) {
  if (bool all; AsksForHelp(arguments, &all)) {
    std::cout << HelpText(command, all);
    return 0;
  }
  return command.run(ParseFlags(command, arguments));
}

int Run(const Arguments& arguments) {
  const std::string name = arguments.empty() ? "" : arguments[0];
  const std::vector<Command> commands = Commands();
  if (name == "--help" || name == "-h" || name == "help") {
    std::cout << OverviewText(commands);
    return 0;
  }
  if (name == "--version") {
    std::cout << "pbnbrdf " << PBNBRDF_VERSION << "\n";
    return 0;
  }
  std::string names;
  for (const Command& command : commands) {
    if (command.name == name) return RunCommand(command, {arguments.begin() + 1, arguments.end()});
    names += StrCat(names.empty() ? "" : " | ", command.name);
  }
  CheckOldCommand(name);
  if (name.empty()) throw UsageError(StrCat("no command given: ", names, "; see pbnbrdf --help"));
  throw UsageError(StrCat("'", name, "' is not a command: ", names, "; see pbnbrdf --help"));
}

// Ceres logs by glog. What it has to say comes back in its summary: nothing is logged anywhere.
void SilenceLog(const char* program) {
  google::InitGoogleLogging(program);
  google::SetStderrLogging(google::GLOG_FATAL);
  for (int severity = google::GLOG_INFO; severity <= google::GLOG_FATAL; ++severity) {
    google::SetLogDestination(severity, "");
  }
}

// One line, whatever names and texts are quoted in it.
void PrintError(std::string message) {
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  std::fprintf(stderr, "pbnbrdf: %s\n", message.c_str());
}

}  // namespace
}  // namespace pbnbrdf::cli

int main(int argc, char** argv) {
  using pbnbrdf::cli::PrintError;
  pbnbrdf::cli::SilenceLog(argv[0]);
  // Written at once at the end, where a failure is seen with its reason; not on a terminal.
  static char buffer[1 << 20];
  if (isatty(STDOUT_FILENO) == 0) std::setvbuf(stdout, buffer, _IOFBF, sizeof(buffer));
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error of the write
  try {
    const int status = pbnbrdf::cli::Run({argv + 1, argv + argc});
    pbnbrdf::WriteFile("-", "");  // fails if what was printed before doesn't arrive
    return status;
  } catch (const pbnbrdf::UsageError& error) {
    PrintError(error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    PrintError("out of memory");
  } catch (const std::exception& error) {
    PrintError(error.what());
  }
  return 1;
}
