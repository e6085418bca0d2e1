// fit_flags.h: the flags that describe a fit.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf::cli {

// The names of the flags that make up a problem; those of how to solve it are in SolverFlagNames.
std::vector<std::string> ProblemFlagNames();
std::vector<std::string> SolverFlagNames();

// Throw UsageError if a flag's value is none that the flag takes.
FitProblem ProblemFromFlags();
FitOptions OptionsFromFlags();

}  // namespace pbnbrdf::cli
