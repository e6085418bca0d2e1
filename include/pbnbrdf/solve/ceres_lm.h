// ceres_lm.h: Ceres' Levenberg-Marquardt.
#pragma once

#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/solve/stage.h"

namespace pbnbrdf {

// Minimises `problem`, whose parameter blocks lie in a vector of weights that is the caller's: where to
// start, and on return and in callbacks the best found. Throws Error if Ceres finds no usable step.
StageResult MinimizeCeresLm(ceres::Problem* problem, const StageOptions& options);

}  // namespace pbnbrdf
