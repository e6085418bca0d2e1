// fit_flags.h: the flags that describe a fit.
#pragma once

#include <string>
#include <vector>

#include "command_line.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf::cli {

// The flags that make up a problem and say how to solve it: with them a fit can be repeated.
std::vector<FlagGroup> ProblemFlags();

// The names of all of them.
std::vector<std::string> ProblemFlagNames();

// A flagfile that repeats a fit: the flags that say what is fitted, and those of the problem.
std::string ProblemFlagfile(std::vector<std::string> subject);

struct FitFlags {
  FitProblem problem;
  FitOptions options;
};

// Throws UsageError if a flag's value is none that the flag takes, or flags don't go together.
FitFlags ParseFitFlags();

// Settles what depends on the material, now that it is known: its channels, and what --encoding=auto
// stands for.
void ResolveNetwork(const Brdf& material, FitProblem* problem);

}  // namespace pbnbrdf::cli
