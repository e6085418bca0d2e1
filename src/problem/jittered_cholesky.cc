#include "pbnbrdf/problem/jittered_cholesky.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace pbnbrdf {
namespace {

// The square roots of the diagonal, none of them 0.
Eigen::VectorXd Scale(const Eigen::MatrixXd& a) {
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    if (a(i, i) > 0.0) least = std::min(least, a(i, i));
  }
  if (!std::isfinite(least)) least = 1.0;
  return a.diagonal().unaryExpr([&](double d) { return std::sqrt(d > 0.0 ? d : least); });
}

}  // namespace

JitteredCholesky FactorWithJitter(const Eigen::MatrixXd& a, double first_jitter) {
  const Eigen::VectorXd scale = Scale(a);
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * a * inverse.asDiagonal();
  JitteredCholesky result;
  for (double jitter = first_jitter;; jitter *= 10.0) {
    result.lower = scaled;
    result.lower.diagonal().array() += jitter;
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(result.lower);
    result.jitter = jitter;
    if (factor.info() == Eigen::Success || jitter > 1.0) break;
  }
  result.lower.triangularView<Eigen::StrictlyUpper>().setZero();
  result.lower = scale.asDiagonal() * result.lower;
  return result;
}

}  // namespace pbnbrdf
