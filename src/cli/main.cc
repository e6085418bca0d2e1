// pbnbrdf: the command line. Finds the subcommand, runs it and turns exceptions into one line.
#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include "commands.h"

namespace pbnbrdf::cli {
namespace {

std::array<Command, 8> Commands() {
  return {FitCommand(),    EvalCommand(), ExportCommand(),  TabulateCommand(),
          ValuesCommand(), InfoCommand(), CompareCommand(), RenderCommand()};
}

std::string Overview() {
  std::string text =
      "pbnbrdf: fits small neural BRDFs that obey physics to measured materials, by nonlinear\n"
      "least squares.\n\n"
      "  pbnbrdf fit --material=builtin:satin-gold --out=gold.safetensors\n"
      "  pbnbrdf eval --fit=gold.safetensors --material=builtin:satin-gold\n\n"
      "Commands:\n";
  for (const Command& command : Commands()) {
    text += StrCat("  ", command.name, std::string(10 - command.name.size(), ' '), command.summary,
                   "\n");
  }
  return text + "\npbnbrdf COMMAND --help explains each; pbnbrdf --version tells the version.\n";
}

int Run(const std::vector<std::string>& arguments) {
  const std::string name = arguments.empty() ? "" : arguments[0];
  if (name == "--help" || name == "-h" || name == "help") {
    std::cout << Overview();
    return 0;
  }
  if (name == "--version") {
    std::cout << "pbnbrdf " << PBNBRDF_VERSION << "\n";
    return 0;
  }
  std::string names;
  for (const Command& command : Commands()) {
    names += StrCat(names.empty() ? "" : " | ", command.name);
    if (command.name != name) continue;
    const std::vector<std::string> rest(arguments.begin() + 1, arguments.end());
    for (const std::string& argument : rest) {
      if (argument == "--help" || argument == "-h" || argument == "--helpshort") {
        std::cout << HelpText(command);
        return 0;
      }
    }
    return command.run(ParseFlags(command, rest));
  }
  if (name.empty()) throw UsageError(StrCat("no command given: ", names, "; see pbnbrdf --help"));
  throw UsageError(StrCat("'", name, "' is not a command: ", names, "; see pbnbrdf --help"));
}

}  // namespace
}  // namespace pbnbrdf::cli

int main(int argc, char** argv) {
  FLAGS_logtostderr = true;
  FLAGS_minloglevel = google::GLOG_FATAL;  // what Ceres has to say comes back in its summary
  google::InitGoogleLogging(argv[0]);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error of the write
  const auto fail = [](std::string message, int status) {
    // One line, whatever names and texts are quoted in it.
    std::replace_if(
        message.begin(), message.end(), [](unsigned char c) { return c < ' ' || c == 127; }, '?');
    std::fprintf(stderr, "pbnbrdf: %s\n", message.c_str());
    return status;
  };
  try {
    return pbnbrdf::cli::Run({argv + 1, argv + argc});
  } catch (const pbnbrdf::cli::UsageError& error) {
    return fail(error.what(), 2);
  } catch (const pbnbrdf::Error& error) {
    return fail(error.what(), 1);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", 1);
  } catch (const std::exception& error) {
    return fail(error.what(), 1);
  }
}
