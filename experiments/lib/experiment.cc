#include "experiment.h"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kHelpWidth = 100;  // characters

// The words of `text` from column `indent` on, in lines of at most kHelpWidth characters.
std::string Wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string lines, line(indent, ' ');
  for (std::string word; words >> word;) {
    if (line.size() > indent && line.size() + 1 + word.size() > kHelpWidth) {
      lines += line + "\n";
      line.assign(indent, ' ');
    }
    line += (line.size() > indent ? " " : "") + word;
  }
  return lines + line + "\n";
}

std::string HelpText(const std::string& usage, const Fields& fields) {
  std::string help = usage + "\nFlags, with their defaults:\n";
  std::string group;
  for (const Field& field : fields.all()) {
    if (field.group != group) help += StrCat("\n", field.group, ":\n");
    group = field.group;
    help += StrCat("  --", field.name, "=", field.default_text, "\n", Wrapped(field.help, 6));
  }
  return help;
}

}  // namespace

Output::Output(std::string folder) : folder_(std::move(folder)) {
  std::filesystem::create_directories(folder_);
}

void Output::WriteReport(const std::string& name, const std::string& markdown) const {
  std::cout << markdown << std::flush;
  WriteFile(Path(name + ".md"), markdown);
}

void Output::WriteFigure(const std::string& name, const Figure& figure) const {
  const std::string problem = DrawFigure(figure, Path(name + ".svg"));
  if (!problem.empty()) std::fprintf(stderr, "%s\n", problem.c_str());
}

int RunExperiment(int argc, char** argv, const std::string& usage, Fields fields,
                  const std::function<void(const Arguments&, const Output&)>& run) {
  std::string folder = ".";
  Fields all;
  all.Add(Text("out_dir", &folder, "folder to write to"));
  all.Add(fields);
  const Arguments words(argv + 1, argv + argc);
  try {
    for (const std::string& word : words) {
      if (word != "--help") continue;
      std::cout << HelpText(usage, all);
      return 0;
    }
    const Arguments arguments = all.ReadFlags(words);
    all.Check();
    run(arguments, Output(folder));
    return 0;
  } catch (const std::exception& error) {
    const std::string program = std::filesystem::path(argv[0]).filename();
    std::fprintf(stderr, "%s: %s\n", program.c_str(), error.what());
    return 1;
  }
}

}  // namespace pbnbrdf
