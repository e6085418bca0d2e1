#include "problem/condensed_cost_function.h"

#include <algorithm>
#include <cmath>

#include "problem/jittered_cholesky.h"

namespace pbnbrdf {

CondensedCostFunction::CondensedCostFunction(Objective* objective) : objective_(objective) {
  const NetworkShape& shape = objective->shape();
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    mutable_parameter_block_sizes()->push_back(shape.block_size(layer));
  }
  set_num_residuals(shape.num_weights() + 1);
}

bool CondensedCostFunction::Evaluate(double const* const* parameters, double* residuals,
                                     double** jacobians) const {
  const NetworkShape& shape = objective_->shape();
  const int p = shape.num_weights();
  std::vector<double> weights;
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    weights.insert(weights.end(), parameters[layer], parameters[layer] + shape.block_size(layer));
  }
  if (jacobians == nullptr) return EvaluateCost(weights, residuals);

  Linearization at;
  if (!objective_->Linearize(weights.data(), &at)) return false;
  const JitteredCholesky factor =
      FactorWithJitter(at.hessian.data(), p, objective_->HessianRounding());
  double* projected = residuals;
  std::copy(at.gradient.begin(), at.gradient.end(), projected);
  factor.lower.SolveLower(projected);
  double rest = 2.0 * at.cost;
  for (int i = 0; i < p; ++i) rest -= projected[i] * projected[i];
  residuals[p] = std::sqrt(std::max(0.0, rest));
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    if (jacobians[layer] == nullptr) continue;
    // L', whose column for a weight is that weight's row of L; then the row of zeros.
    const int columns = shape.block_size(layer);
    std::fill_n(jacobians[layer], static_cast<std::size_t>(p + 1) * columns, 0.0);
    for (int column = 0; column < columns; ++column) {
      const int weight = shape.offset(layer) + column;
      for (int i = 0; i <= weight; ++i) {
        jacobians[layer][static_cast<std::size_t>(i) * columns + column] =
            factor.lower.row(weight)[i];
      }
    }
  }
  return true;
}

bool CondensedCostFunction::EvaluateCost(const std::vector<double>& weights,
                                         double* residuals) const {
  const double cost = objective_->Cost(weights.data());
  if (!std::isfinite(cost)) return false;
  std::fill(residuals, residuals + num_residuals() - 1, 0.0);
  residuals[num_residuals() - 1] = std::sqrt(2.0 * cost);
  return true;
}

}  // namespace pbnbrdf
