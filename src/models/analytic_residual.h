// analytic_residual.h: the numbers that a fit of an analytic model searches, and the log residual (eq. 6) of
// one sample as Ceres' function of them.
#pragma once

#include <ceres/cost_function.h>

#include <cmath>
#include <memory>
#include <vector>

#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {

// Logarithms stand for the parameters that are logarithmic; for isotropic materials some parameters
// follow from others and aren't searched.
class FreeParameters {
 public:
  FreeParameters(const AnalyticModel& model, int lobes, bool isotropic);

  std::size_t size() const { return lower_.size(); }
  std::size_t num_scalars() const { return rules_.size(); }
  // Bounds of the numbers.
  const std::vector<double>& lower() const { return lower_; }
  const std::vector<double>& upper() const { return upper_; }

  // numbers: T[size()], scalars: T[num_scalars()]; double or Ceres' jets.
  template <typename T>
  void ToScalars(const T* numbers, T* scalars) const {
    using std::exp;
    for (std::size_t i = 0; i < rules_.size(); ++i) {
      switch (rules_[i]) {
        case Rule::kLinear:
          scalars[i] = *numbers++;
          break;
        case Rule::kLogarithmic:
          scalars[i] = exp(*numbers++);
          break;
        case Rule::kAsPrevious:
          scalars[i] = scalars[i - 1];
          break;
        case Rule::kZero:
          scalars[i] = T(0.0);
          break;
      }
    }
  }

  // The scalars within their bounds, whatever rounding did.
  std::vector<double> ToBoundedScalars(const std::vector<double>& numbers) const;

  // Of scalars within their bounds.
  std::vector<double> FromScalars(const std::vector<double>& scalars) const;

 private:
  enum class Rule { kLinear, kLogarithmic, kAsPrevious, kZero };

  std::vector<Rule> rules_;                          // of each scalar
  std::vector<double> scalar_lower_, scalar_upper_;  // likewise
  std::vector<double> lower_, upper_;                // of each number
};

// One parameter block, the numbers of `parameters`, which must outlive the function; 3 residuals,
// log1p(f_c cos_i) - log1p(f^_c cos_i), and derivatives by jets.
std::unique_ptr<ceres::CostFunction> MakeAnalyticResidual(const AnalyticModel& model, int lobes,
                                                          const FreeParameters& parameters,
                                                          const BrdfSample& sample);

}  // namespace pbnbrdf
