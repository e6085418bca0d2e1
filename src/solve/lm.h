// lm.h: Levenberg-Marquardt on the normal equations of an Objective.
//
// The steps are those of Ceres' trust region [1]; what differs is the linear algebra, which
// Debian's libceres has compiled for any x86-64: an iteration here costs little more than the
// Linearization.
//
// [1] S. Agarwal, K. Mierle and others. Ceres Solver, version 2.1; its user guide names the
// sources,
//     foremost K. Madsen, H. Nielsen, O. Tingleff. Methods for Non-Linear Least Squares Problems.
//     2004 (the radius), and A. Conn, N. Gould, P. Toint. Trust-Region Methods. SIAM 2000, algorithm
//     10.1.2 (steps that may raise the cost).
#pragma once

#include "solve/stage.h"

namespace pbnbrdf {

// weights: where to start, and on return and in callbacks the best found. Diverged if the objective
// isn't finite at the start; converged at once where its gradient is 0.
StageResult MinimizeLm(Objective* objective, const StageOptions& options,
                       std::vector<double>* weights);

}  // namespace pbnbrdf
