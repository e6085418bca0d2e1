// pbnbrdf: the command line. Finds the subcommand, runs it and turns exceptions into one line.
#include <glog/logging.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include "command_line.h"
#include "help.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf::cli {
namespace {

// In the order in which people need them.
std::vector<Command> Commands() {
  return {FitCommand(),     MeasureCommand(),  InfoCommand(),     EvalCommand(), ExportCommand(),
#ifdef PBNBRDF_HAS_RENDER
          ReportCommand(),  RenderCommand(),   FitSceneCommand(),
#endif
          CompareCommand(), FitModelCommand(), PriorCommand(),    PlanCommand()};
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
  if (name == "--manual") {
    std::cout << ManualPage(commands);
    return 0;
  }
  if (name == "--completion") {
    std::cout << BashCompletion(commands);
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

void PrintError(const char* message) { std::fprintf(stderr, "pbnbrdf: %s\n", message); }

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
