// ceres_problem.h: a fit as a ceres::Problem of one parameter block a layer, in two ways.
#pragma once

#include <ceres/problem.h>

#include <span>

#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

// One block of P + 1 residuals, whose normal equations are those of all samples
// (condensed_cost_function.h). weights: shape().num_weights() numbers, the parameter blocks. objective and
// weights must outlive `ceres_problem`.
void AddCondensed(Objective* objective, double* weights, ceres::Problem* ceres_problem);

// A block for each sample and term, and for each stratum of the energy term, differentiated by jets
// through the whole network: the slow reference.
void AddAutodiff(const FitProblem& problem, std::span<const BrdfSample> samples,
                 std::span<const EnergyStratum> strata, double* weights,
                 ceres::Problem* ceres_problem);

}  // namespace pbnbrdf
