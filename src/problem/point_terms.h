// point_terms.h: the terms of a fit that are means over samples: residuals, robust weights and
// derivatives with respect to the network's outputs.
#pragma once

#include <ceres/jet.h>
#include <ceres/loss_function.h>

#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "kernels/losses.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {

// sum of rho(s) of one sample's residuals of a term, and the scale sqrt(weight rho'(s)) of its
// rows.
struct RobustWeight {
  double cost, row_scale;
};

inline RobustWeight Robustify(const ceres::LossFunction* loss, double weight, double squared_norm) {
  double rho[3] = {squared_norm, 1.0, 0.0};
  if (loss != nullptr) loss->Evaluate(squared_norm, rho);
  return {0.5 * weight * rho[0], std::sqrt(weight * rho[1])};
}

inline double Sign(double x) { return (x > 0.0) - (x < 0.0); }

// A term at the training samples: residuals of Term, which takes the outputs of one sample.
template <typename Term>
class PointTerm {
 public:
  static constexpr int kRows = Term::kNumResiduals;

  // weight: of the mean over the samples; 0 makes it an absent term, without rows.
  PointTerm(double weight, const FitProblem& problem, std::span<const BrdfSample> samples)
      : weight_(weight / static_cast<double>(samples.size())),
        absolute_(problem.loss == Loss::kAbsolute),
        loss_(MakeLoss(problem.loss, problem.loss_scale)) {
    if (weight == 0.0) return;
    residuals_.reserve(samples.size());
    for (const BrdfSample& s : samples) residuals_.emplace_back(s.value, CosI(s.pair));
  }

  int rows() const { return weight_ > 0.0 ? kRows : 0; }

  double Cost(std::size_t sample, const double* z) const {
    if (weight_ == 0.0) return 0.0;
    double r[kRows];
    residuals_[sample](z, r);
    double squared_norm = 0.0, absolute_sum = 0.0;
    for (double value : r) {
      squared_norm += value * value;
      absolute_sum += std::abs(value);
    }
    if (absolute_) return weight_ / kRows * absolute_sum;
    return Robustify(loss_.get(), weight_, squared_norm).cost;
  }

  // Calls set(row, residual, gradient with respect to z) for each row. Returns the cost.
  template <typename SetRow>
  double Linearize(std::size_t sample, const double* z, SetRow set) const {
    if (weight_ == 0.0) return 0.0;
    using Jet = ceres::Jet<double, NetworkShape::kChannels>;
    Jet outputs[NetworkShape::kChannels], r[kRows];
    for (int c = 0; c < NetworkShape::kChannels; ++c) outputs[c] = Jet(z[c], c);
    residuals_[sample](outputs, r);
    if (absolute_) return SetSigns(r, set);
    double squared_norm = 0.0;
    for (const Jet& value : r) squared_norm += value.a * value.a;
    const RobustWeight robust = Robustify(loss_.get(), weight_, squared_norm);
    for (int row = 0; row < kRows; ++row) {
      const Eigen::Vector3d gradient = robust.row_scale * r[row].v;
      set(row, robust.row_scale * r[row].a, gradient.data());
    }
    return robust.cost;
  }

 private:
  // The sum of absolute values has the gradient of a sum of products with the signs.
  template <typename Jet, typename SetRow>
  double SetSigns(const Jet* r, SetRow set) const {
    double sum = 0.0;
    for (int row = 0; row < kRows; ++row) {
      set(row, weight_ / kRows * Sign(r[row].a), r[row].v.data());
      sum += std::abs(r[row].a);
    }
    return weight_ / kRows * sum;
  }

  double weight_;
  bool absolute_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::vector<Term> residuals_;  // one a sample
};

// The log term, a batch at a time: LogResidual and its derivative, vectorised.
class LogTerm {
 public:
  // Residuals and slopes d r_c / d z_c of a batch, by feature.
  struct Batch {
    AlignedVector<double> residuals =
        AlignedVector<double>(NetworkShape::kChannels * kernels::kBatch);
    AlignedVector<double> slopes = AlignedVector<double>(NetworkShape::kChannels * kernels::kBatch);
  };

  // weight: of the mean over the samples; 0 makes it an absent term, without rows.
  LogTerm(double weight, const FitProblem& problem, std::span<const BrdfSample> samples)
      : weight_(weight / static_cast<double>(samples.size())),
        absolute_(problem.loss == Loss::kAbsolute),
        loss_(MakeLoss(problem.loss, problem.loss_scale)) {
    const std::size_t padded =
        (samples.size() + kernels::kBatch - 1) / kernels::kBatch * kernels::kBatch;
    cos_i_.resize(padded);
    targets_.resize(NetworkShape::kChannels * padded);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      cos_i_[n] = CosI(samples[n].pair);
      double* target = &targets_[n / kernels::kBatch * NetworkShape::kChannels * kernels::kBatch +
                                 n % kernels::kBatch];
      for (int c = 0; c < NetworkShape::kChannels; ++c) {
        target[c * kernels::kBatch] = std::log1p(samples[n].value[c] * cos_i_[n]);
      }
    }
  }

  int rows() const { return weight_ > 0.0 ? NetworkShape::kChannels : 0; }

  // z: the outputs at batch b, by feature.
  template <typename T>
  void Evaluate(std::size_t b, const T* z, Batch* batch) const {
    kernels::LogResiduals(z, &targets_[b * NetworkShape::kChannels * kernels::kBatch],
                          &cos_i_[b * kernels::kBatch], batch->residuals.data(),
                          batch->slopes.data());
  }

  double Cost(const Batch& batch, int n) const {
    if (weight_ == 0.0) return 0.0;
    return absolute_ ? AbsoluteSum(batch, n) : Robust(batch, n).cost;
  }

  // Calls set(row, residual, gradient with respect to z) for each row of the batch's sample n.
  // Returns the cost.
  template <typename SetRow>
  double Linearize(const Batch& batch, int n, SetRow set) const {
    if (weight_ == 0.0) return 0.0;
    const RobustWeight robust =
        absolute_ ? RobustWeight{AbsoluteSum(batch, n), 1.0} : Robust(batch, n);
    for (int c = 0; c < NetworkShape::kChannels; ++c) {
      const double r = batch.residuals[c * kernels::kBatch + n];
      double gradient[NetworkShape::kChannels] = {};
      gradient[c] = robust.row_scale * batch.slopes[c * kernels::kBatch + n];
      set(c, absolute_ ? weight_ / NetworkShape::kChannels * Sign(r) : robust.row_scale * r,
          gradient);
    }
    return robust.cost;
  }

 private:
  double AbsoluteSum(const Batch& batch, int n) const {
    double sum = 0.0;
    for (int c = 0; c < NetworkShape::kChannels; ++c)
      sum += std::abs(batch.residuals[c * kernels::kBatch + n]);
    return weight_ / NetworkShape::kChannels * sum;
  }

  RobustWeight Robust(const Batch& batch, int n) const {
    double squared_norm = 0.0;
    for (int c = 0; c < NetworkShape::kChannels; ++c) {
      const double r = batch.residuals[c * kernels::kBatch + n];
      squared_norm += r * r;
    }
    return Robustify(loss_.get(), weight_, squared_norm);
  }

  double weight_;
  bool absolute_;
  std::unique_ptr<ceres::LossFunction> loss_;
  AlignedVector<double> cos_i_;    // batch after batch
  AlignedVector<double> targets_;  // log1p(f cos_i), batch after batch, each by feature
};

}  // namespace pbnbrdf
