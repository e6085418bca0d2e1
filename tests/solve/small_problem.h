// small_problem.h: a problem that is solved in a moment.
#pragma once

#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// Without an energy term.
inline FitProblem SmallProblem() {
  FitProblem problem;
  problem.hidden = {6};
  problem.samples = 500;
  problem.energy_weight = 0.0;
  return problem;
}

}  // namespace pbnbrdf
