#include "pbnbrdf/problem/condensed_cost_function.h"

#include <Eigen/Core>
#include <cmath>

#include "pbnbrdf/problem/jittered_cholesky.h"

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
      FactorWithJitter(Eigen::Map<const Eigen::MatrixXd>(at.hessian.data(), p, p),
                       objective_->HessianRounding());
  Eigen::Map<Eigen::VectorXd> projected(residuals, p);
  projected = factor.lower.triangularView<Eigen::Lower>().solve(
      Eigen::Map<const Eigen::VectorXd>(at.gradient.data(), p));
  residuals[p] = std::sqrt(std::max(0.0, 2.0 * at.cost - projected.squaredNorm()));

  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    if (jacobians[layer] == nullptr) continue;
    const int columns = shape.block_size(layer);
    Eigen::Map<RowMajor> jacobian(jacobians[layer], p + 1, columns);
    jacobian.topRows(p) = factor.lower.middleRows(shape.offset(layer), columns).transpose();
    jacobian.row(p).setZero();
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
