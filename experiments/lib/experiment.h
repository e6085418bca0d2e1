// experiment.h: what each program of experiments/ begins and ends with: its options, its help, its files.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "figure.h"

namespace pbnbrdf {

// The folder that a program writes to.
class Output {
 public:
  // Makes the folder.
  explicit Output(std::string folder);

  // Of a file in the folder.
  std::string Path(const std::string& file) const { return folder_ + "/" + file; }

  // Prints Markdown to standard output and writes it to NAME.md.
  void WriteReport(const std::string& name, const std::string& markdown) const;

  // Writes NAME.svg, or says on standard error why there is none.
  void WriteFigure(const std::string& name, const Figure& figure) const;

 private:
  std::string folder_;
};

using Arguments = std::vector<std::string>;

// A program's main. Sets the fields from the flags of the command line (Fields::ReadFlags) and calls `run`
// with the arguments that aren't flags. --out_dir is a flag of
// every program. --help prints `usage` and the flags. Returns the exit status: 0, or 1 after an Error,
// which is one line on standard error.
int RunExperiment(int argc, char** argv, const std::string& usage, Fields fields,
                  const std::function<void(const Arguments&, const Output&)>& run);

// The same, of options that `fields` makes fields of.
template <typename Options>
int RunExperiment(int argc, char** argv, const std::string& usage, Fields (*fields)(Options*),
                  void (*run)(const Options&, const Arguments&, const Output&)) {
  Options options;
  return RunExperiment(
      argc, argv, usage, fields(&options),
      [&](const Arguments& arguments, const Output& output) { run(options, arguments, output); });
}

}  // namespace pbnbrdf
