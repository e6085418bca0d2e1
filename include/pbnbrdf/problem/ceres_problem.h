// ceres_problem.h: a fit as a ceres::Problem of one parameter block a layer, in two ways.
#pragma once

#include <ceres/problem.h>

#include <span>

#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

enum class JacobianMethod {
  kCondensed,  // one block of P + 1 residuals (condensed_cost_function.h)
  kAutodiff,   // a block a sample and term, jets through the whole network: the slow reference
};

inline constexpr NameTable<JacobianMethod, 2> kJacobianMethods = {
    {{"condensed", JacobianMethod::kCondensed}, {"autodiff", JacobianMethod::kAutodiff}}};

// weights: shape().num_weights() numbers, the parameter blocks. objective and weights must outlive
// `ceres_problem`.
void AddCondensed(Objective* objective, double* weights, ceres::Problem* ceres_problem);

void AddAutodiff(const FitProblem& problem, std::span<const BrdfSample> samples,
                 std::span<const EnergyStratum> strata, double* weights,
                 ceres::Problem* ceres_problem);

}  // namespace pbnbrdf
