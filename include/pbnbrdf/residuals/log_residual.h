// log_residual.h: the log term, eq. 6.
#pragma once

#include <cmath>
#include <string_view>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {

// r_c = log(1 + f_c cos_i) - log(1 + f^_c cos_i),  c = R, G, B;  f^_c = expm1(z_c).
//   z         T[3], the network's output at the sample's directions.
//   residuals T[3], unitless.
class LogResidual {
 public:
  static constexpr std::string_view kName = "log", kHelp = "eq. 6";
  static constexpr double kDefaultWeight = 1.0;
  static constexpr bool kNeedsColor = false;  // whether it says nothing of a single channel
  static constexpr int kNumResiduals = 3;

  // f: 1/sr, >= 0. cos_i in [0, 1].
  LogResidual(const Rgb& f, double cos_i) : cos_i_(cos_i) {
    for (int c = 0; c < 3; ++c) target_[c] = std::log1p(f[c] * cos_i);
  }

  template <typename T>
  void operator()(const T* z, T* residuals) const {
    using std::log1p;
    for (int c = 0; c < 3; ++c) {
      // log1p(expm1(z)) is z, and computed the logarithm of 0 where z < -37.
      residuals[c] = target_[c] - (cos_i_ == 1.0 ? z[c] : log1p(Reflectance(z[c]) * cos_i_));
    }
  }

 private:
  double cos_i_;
  Rgb target_;
};

}  // namespace pbnbrdf
