#include "database/family_step.h"

#include <Eigen/Cholesky>

#include "base/parallel.h"

namespace pbnbrdf {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::MatrixXf, Eigen::VectorXd;

constexpr int kMaxConjugateSteps = 40;
constexpr double kResidualTolerance = 1e-3;  // of the preconditioned residual's square
// The damping is at least so much of the largest: of weights, of codes.
constexpr double kMinWeightDamping = 1e-9, kMinCodeDamping = 1e-6;
constexpr float kRounding = 1e-5f,
                kMoreRounding = 1e-2f;  // of a block's diagonal, so that it factors

// One call for each index.
template <typename Function>
void ForEach(Index count, Function function) {
  ParallelFor(static_cast<std::size_t>(count),
              [&](std::size_t k) { function(static_cast<Index>(k)); });
}

double Dot(const FamilyPoint& a, const FamilyPoint& b) {
  return a.weights.cwiseProduct(b.weights).sum() + a.codes.cwiseProduct(b.codes).sum();
}

// a + factor * b
FamilyPoint Sum(const FamilyPoint& a, double factor, const FamilyPoint& b) {
  return {a.weights + factor * b.weights, a.codes + factor * b.codes};
}

Eigen::LLT<MatrixXf> FactorRounded(MatrixXf matrix) {
  matrix.diagonal() *= 1.0f + kRounding;
  Eigen::LLT<MatrixXf> factor(matrix);
  if (factor.info() == Eigen::Success) return factor;
  matrix.diagonal() *= 1.0f + kMoreRounding;
  return Eigen::LLT<MatrixXf>(matrix);
}

// The model's matrix, damped, and its blocks.
class DampedModel {
 public:
  DampedModel(const FamilyPoint& point, const FamilyLinearization& at, double ridge, double radius)
      : basis_(point.basis()), factors_(point.Factors()), at_(at), ridge_(ridge) {
    const MatrixXf basis = basis_.cast<float>();
    own_.resize(at.hessians.size());
    MatrixXd diagonals(basis_.rows(), point.num_materials());
    ForEach(point.num_materials(), [&](Index m) {
      const MatrixXf& hessian = Hessian(m);
      own_[m] = (basis.transpose() * (hessian * basis)).cast<double>();
      diagonals.col(m) = hessian.diagonal().cast<double>();
    });
    damping_.weights = diagonals * factors_.array().square().matrix();
    damping_.weights = damping_.weights.cwiseMax(kMinWeightDamping * damping_.weights.maxCoeff());
    damping_.weights /= radius;
    damping_.codes.resize(point.num_materials(), point.code_size());
    for (Index m = 0; m < point.num_materials(); ++m) {
      damping_.codes.row(m) = own_[m].diagonal().transpose();
    }
    if (damping_.codes.size() > 0) {
      damping_.codes = damping_.codes.cwiseMax(kMinCodeDamping * damping_.codes.maxCoeff());
      damping_.codes /= radius;
    }
    FactorBlocks();
  }

  FamilyPoint Times(const FamilyPoint& x) const {
    const MatrixXd moves = x.weights * factors_.transpose() + basis_ * x.codes.transpose();
    MatrixXd forces(moves.rows(), moves.cols());
    ForEach(moves.cols(), [&](Index m) {
      forces.col(m) = (Hessian(m) * moves.col(m).cast<float>()).cast<double>();
    });
    return {forces * factors_ + damping_.weights.cwiseProduct(x.weights),
            forces.transpose() * basis_ + ridge_ * x.codes + damping_.codes.cwiseProduct(x.codes)};
  }

  // By the blocks alone.
  FamilyPoint Solve(const FamilyPoint& b) const {
    FamilyPoint x = b;
    ForEach(b.weights.cols(), [&](Index k) {
      x.weights.col(k) = columns_[k].solve(b.weights.col(k).cast<float>()).cast<double>();
    });
    if (b.code_size() == 0) return x;
    for (Index m = 0; m < b.num_materials(); ++m) {
      x.codes.row(m) = codes_[m].solve(b.codes.row(m).transpose()).transpose();
    }
    return x;
  }

 private:
  const MatrixXf& Hessian(Index m) const { return at_.hessians[static_cast<std::size_t>(m)]; }

  void FactorBlocks() {
    columns_.resize(static_cast<std::size_t>(factors_.cols()));
    ForEach(factors_.cols(), [&](Index k) {
      MatrixXf sum = MatrixXf::Zero(basis_.rows(), basis_.rows());
      for (Index m = 0; m < factors_.rows(); ++m) {
        sum += static_cast<float>(factors_(m, k) * factors_(m, k)) * Hessian(m);
      }
      sum.diagonal() += damping_.weights.col(k).cast<float>();
      columns_[k] = FactorRounded(std::move(sum));
    });
    if (damping_.codes.cols() == 0) return;
    for (Index m = 0; m < factors_.rows(); ++m) {
      MatrixXd block = own_[m];
      block.diagonal() += damping_.codes.row(m).transpose();
      block.diagonal().array() += ridge_;
      codes_.emplace_back(block);
    }
  }

  const MatrixXd basis_, factors_;
  const FamilyLinearization& at_;
  double ridge_;
  FamilyPoint damping_;
  std::vector<MatrixXd> own_;  // J'J of each material with respect to its code
  std::vector<Eigen::LLT<MatrixXf>> columns_;
  std::vector<Eigen::LLT<MatrixXd>> codes_;
};

}  // namespace

FamilyStep DampedStep(const FamilyPoint& point, const FamilyLinearization& at, double ridge,
                      double radius) {
  const DampedModel model(point, at, ridge, radius);
  const FamilyPoint gradient = {at.gradients * point.Factors(),
                                at.gradients.transpose() * point.basis() + ridge * point.codes};
  FamilyPoint step = {MatrixXd::Zero(gradient.weights.rows(), gradient.weights.cols()),
                      MatrixXd::Zero(gradient.codes.rows(), gradient.codes.cols())};
  FamilyPoint rest = Sum(step, -1.0, gradient), solved = model.Solve(rest), direction = solved;
  double square = Dot(rest, solved);
  const double first = square;
  for (int k = 0; k < kMaxConjugateSteps && square > kResidualTolerance * first; ++k) {
    const FamilyPoint product = model.Times(direction);
    const double curvature = Dot(direction, product);
    if (!(curvature > 0.0)) break;
    step = Sum(step, square / curvature, direction);
    rest = Sum(rest, -square / curvature, product);
    solved = model.Solve(rest);
    const double next = Dot(rest, solved);
    direction = Sum(solved, next / square, direction);
    square = next;
  }
  return {step, -0.5 * Dot(gradient, step)};
}

}  // namespace pbnbrdf
