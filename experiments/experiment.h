// experiment.h: what each program of this folder begins and ends with: flags, help, files.
#pragma once

#include <gflags/gflags.h>

#include <functional>
#include <string>
#include <vector>

#include "figure.h"
#include "table.h"

DECLARE_string(out_dir);

namespace pbnbrdf {

// A program's main: reads the flags, makes the folder --out_dir and calls `run` with the arguments
// that aren't flags. --help prints `usage` and the flags. Returns the exit status; an Error is one
// line on standard error.
int RunExperiment(int argc, char** argv, const std::string& usage,
                  void (*run)(const std::vector<std::string>& arguments));

// The path of a file in --out_dir.
std::string OutputPath(const std::string& file);

// Prints Markdown to standard output and writes it to NAME.md.
void WriteReport(const std::string& name, const std::string& markdown);

// Writes NAME.svg, or says on standard error why there is none.
void WriteFigure(const std::string& name, const Figure& figure);

// Flags that hold lists. Each throws Error, which names the flag.
std::vector<std::size_t> ParseCounts(const std::string& flag, const std::string& text);  // "1e3,50"
// Sizes of hidden layers, the networks separated by blanks: "21,21 32,32".
std::vector<std::vector<int>> ParseNetworks(const std::string& flag, const std::string& text);

// Calls `work` with each of 0 ... count - 1, some at a time in threads of their own. The first Error
// that one throws ends all, and is thrown when they have ended.
void ForEach(std::size_t count, int at_a_time, const std::function<void(std::size_t)>& work);

// "21-21"
std::string HiddenName(const std::vector<int>& hidden);

}  // namespace pbnbrdf
