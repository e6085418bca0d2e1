#include "database/code_minimizer.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace pbnbrdf {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

constexpr int kMaxIterations = 60;
constexpr double kFirstRadius = 10.0, kMinRadius = 1e-10, kGrowth = 3.0;
constexpr double kMinQuality = 1e-3, kGoodQuality = 0.5;  // of a step
constexpr double kMinDiagonal = 1e-9;                     // of the largest
constexpr double kTolerance = 1e-5;                       // of the cost: where a step ends it

class Minimizer {
 public:
  Minimizer(const WeightFamily& family, double ridge, Objective* objective)
      : family_(family),
        basis_(Eigen::Map<const MatrixXd>(family.basis().data(), family.shape().num_weights(),
                                          family.code_size())),
        ridge_(ridge),
        objective_(objective) {}

  CodeMinimum Run(std::vector<double> start) {
    VectorXd code = Eigen::Map<VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
    double cost = Cost(code), radius = kFirstRadius;
    bool is_new = true;
    for (int k = 0; k < kMaxIterations && radius > kMinRadius; ++k) {
      if (is_new && !Linearize(code)) break;
      const VectorXd damping =
          hessian_.diagonal().cwiseMax(kMinDiagonal * hessian_.diagonal().maxCoeff()) / radius;
      const VectorXd step = (hessian_ + MatrixXd(damping.asDiagonal())).ldlt().solve(-gradient_);
      const double predicted = -gradient_.dot(step) - 0.5 * step.dot(hessian_ * step);
      const double next = Cost(code + step), quality = (cost - next) / predicted;
      is_new = quality > kMinQuality;
      if (!is_new) {
        radius /= kGrowth * kGrowth;
        continue;
      }
      code += step;
      const bool is_last = cost - next < kTolerance * cost;
      cost = next;
      if (quality > kGoodQuality) radius *= kGrowth;
      if (is_last) break;
    }
    return {{code.begin(), code.end()}, cost};
  }

 private:
  // Infinite where it isn't finite.
  double Cost(const VectorXd& code) {
    const double cost = objective_->Cost(WeightsAt(code).data());
    if (!std::isfinite(cost)) return std::numeric_limits<double>::infinity();
    return cost + 0.5 * ridge_ * code.squaredNorm();
  }

  bool Linearize(const VectorXd& code) {
    Linearization at;
    if (!objective_->Linearize(WeightsAt(code).data(), &at)) return false;
    const auto size = static_cast<Eigen::Index>(at.gradient.size());
    const Eigen::Map<const MatrixXd> hessian(at.hessian.data(), size, size);
    const Eigen::Map<const VectorXd> gradient(at.gradient.data(), size);
    gradient_ = basis_.transpose() * gradient + ridge_ * code;
    hessian_ = basis_.transpose() * (hessian * basis_);
    hessian_.diagonal().array() += ridge_;
    return true;
  }

  std::vector<double> WeightsAt(const VectorXd& code) const {
    return family_.WeightsAt({code.data(), static_cast<std::size_t>(code.size())});
  }

  const WeightFamily& family_;
  const Eigen::Map<const MatrixXd> basis_;
  double ridge_;
  Objective* objective_;
  VectorXd gradient_;
  MatrixXd hessian_;
};

}  // namespace

CodeMinimum MinimizeOverCode(const WeightFamily& family, double ridge, std::vector<double> code,
                             Objective* objective) {
  return Minimizer(family, ridge, objective).Run(std::move(code));
}

}  // namespace pbnbrdf
