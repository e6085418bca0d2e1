// ceres_solvers.h: Ceres' own minimisers: Levenberg-Marquardt and L-BFGS.
#pragma once

#include "pbnbrdf/problem/ceres_problem.h"
#include "solve/stage.h"

namespace pbnbrdf {

// Levenberg-Marquardt (trust region). `problem`'s parameter blocks lie in a vector of weights that
// is the caller's: where to start, and on return and in callbacks the best found. Diverged if Ceres
// finds no usable step.
StageResult MinimizeCeresLm(ceres::Problem* problem, const StageOptions& options);

// L-BFGS with line search; converged too where that finds no lower cost, as at the kinks of
// Loss::kAbsolute. weights: as above. Diverged if the objective isn't finite at the start.
StageResult MinimizeCeresLbfgs(Objective* objective, const StageOptions& options,
                               std::vector<double>* weights);

}  // namespace pbnbrdf
