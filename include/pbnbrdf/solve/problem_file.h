// problem_file.h: problems as files, such as problems/nbrdf.flags: what is minimised, and how. A line
// "--name=value" for each field that isn't to have its default; # begins a comment.
#pragma once

#include <string>

#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {

struct FitSetup {
  FitProblem problem;
  FitOptions options;
};

// Throws Error, naming the file and the field.
FitSetup ReadProblem(const std::string& path);

// Every field, a line each.
std::string ProblemText(const FitSetup& setup);

// Throws Error if the file can't be written.
void WriteProblem(const std::string& path, const FitSetup& setup);

}  // namespace pbnbrdf
