// condensed_cost_function.h: a whole fit as one Ceres residual block of P + 1 residuals.
//
// From A = J'J and g = J'r of all residuals (objective.h) with the factor A = L L', Ceres is given
//
//   residual = [ L^-1 g ; sqrt(2 cost - |L^-1 g|^2) ],   Jacobian = [ L' ; 0 ],
//
// whose normal equations, gradient and cost are those of the full problem: Ceres' trust region does
// what it would have done with all of the residuals, in O(P^2) memory for any number of samples.
// The root is real: rho is concave with rho(0) = 0, so sum of rho' r^2 <= sum of rho = 2 cost, and
// |L^-1 g|^2 is the part of the left side that J's range holds.
#pragma once

#include <ceres/cost_function.h>

#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

// One parameter block a layer (network_shape.h).
class CondensedCostFunction final : public ceres::CostFunction {
 public:
  // objective: not owned, must outlive this. Evaluate must not be called from two threads at once.
  explicit CondensedCostFunction(Objective* objective);

  // False where the objective isn't finite. Without Jacobians the residual is [0 ; sqrt(2 cost)].
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  bool EvaluateCost(const std::vector<double>& weights, double* residuals) const;

  Objective* objective_;
};

}  // namespace pbnbrdf
