// problems.h: the problems of the folder problems/.
#pragma once

#include <string>

#include "pbnbrdf/solve/problem_file.h"

namespace pbnbrdf {

// problems/NAME.flags.
std::string ShippedProblemFile(const std::string& name);

// What it says. Throws Error as ReadProblem does.
FitSetup ShippedProblem(const std::string& name);

}  // namespace pbnbrdf
