// robust_loss.h: what a sample's residuals cost, and how their rows of the Jacobian are weighted.
#pragma once

#include <ceres/loss_function.h>

#include <cmath>
#include <memory>

#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// rho, or null for l2, which Ceres takes for rho(s) = s, and for absolute, which has none.
std::unique_ptr<ceres::LossFunction> MakeLoss(const TermOptions& terms);

// weight times rho(s) / 2 of one sample's residuals of a term, and the scale sqrt(weight rho'(s)) of its
// rows: Ceres' corrector without the second-order part.
struct RobustWeight {
  double cost, row_scale;
};

class RobustLoss {
 public:
  explicit RobustLoss(const TermOptions& terms)
      : is_absolute_(terms.loss == Loss::kAbsolute), loss_(MakeLoss(terms)) {}

  // Whether the cost is the mean of |r| over a term's rows instead.
  bool is_absolute() const { return is_absolute_; }

  // Not if is_absolute().
  RobustWeight At(double weight, double squared_norm) const {
    double rho[3] = {squared_norm, 1.0, 0.0};
    if (loss_ != nullptr) loss_->Evaluate(squared_norm, rho);
    return {0.5 * weight * rho[0], std::sqrt(weight * rho[1])};
  }

 private:
  bool is_absolute_;
  std::unique_ptr<ceres::LossFunction> loss_;
};

}  // namespace pbnbrdf
