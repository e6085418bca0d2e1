// chromaticity_residual.h: the chromaticity term, eq. 7.
#pragma once

#include <cmath>
#include <string_view>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {

// r = log(1 + |f cos_i|^2) - log(1 + |f^ cos_i|^2), |.|^2 the sum over R, G, B;  f^_c = expm1(z_c).
//   z         T[3], the network's output at the sample's directions.
//   residuals T[1], unitless.
class ChromaticityResidual {
 public:
  static constexpr std::string_view kName = "chromaticity", kHelp = "eq. 7";
  static constexpr double kDefaultWeight =
      0.1;  // the least error of colour (experiments/README.md)
  static constexpr bool kNeedsColor = true;
  static constexpr int kNumResiduals = 1;

  // f: 1/sr, >= 0. cos_i in [0, 1].
  ChromaticityResidual(const Rgb& f, double cos_i)
      : cos2_i_(cos_i * cos_i), target_(LogNorm(f.data(), cos2_i_)) {}

  template <typename T>
  void operator()(const T* z, T* residuals) const {
    const T f[3] = {Reflectance(z[0]), Reflectance(z[1]), Reflectance(z[2])};
    residuals[0] = target_ - LogNorm(f, cos2_i_);
  }

 private:
  template <typename T>
  static T LogNorm(const T* f, double cos2_i) {
    using std::log1p;
    return log1p((f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * cos2_i);
  }

  double cos2_i_;
  double target_;
};

}  // namespace pbnbrdf
