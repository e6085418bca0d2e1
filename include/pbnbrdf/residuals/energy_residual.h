// energy_residual.h: the energy amplification term, eq. 5, of one stratum of incident directions.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {

// r_c = sqrt(w) max(0, a_c - l_c),  a_c = sum over nodes m of v_m max(0, f^_c,m),  c = R, G, B,
// the directional albedo by quadrature;  f^_c,m = expm1(z_c,m), clamped as it is when evaluated.
//   z         T[M][3], the network's outputs at the nodes.
//   residuals T[3], unitless.
class EnergyResidual {
 public:
  static constexpr std::string_view kName = "energy", kHelp = "eq. 5";
  static constexpr double kDefaultWeight = 1.0;
  static constexpr int kNumResiduals = 3;

  // solid_angle: w, of the stratum, sr. node_weights: v_m > 0, cosine included (brdf/albedo.h).
  // limit: l, the largest albedo that costs nothing; 1 in eq. 5.
  EnergyResidual(double solid_angle, std::vector<double> node_weights,
                 const Rgb& limit = {1.0, 1.0, 1.0})
      : sqrt_w_(std::sqrt(solid_angle)), v_(std::move(node_weights)), limit_(limit) {}

  template <typename T>
  void operator()(const T* z, T* residuals) const {
    T albedo[3] = {T(0.0), T(0.0), T(0.0)};
    for (std::size_t m = 0; m < v_.size(); ++m) {
      for (int c = 0; c < 3; ++c) {
        if (z[3 * m + c] > T(0.0)) albedo[c] += v_[m] * Reflectance(z[3 * m + c]);
      }
    }
    for (int c = 0; c < 3; ++c) {
      const T excess = albedo[c] - limit_[c];
      residuals[c] = excess > T(0.0) ? sqrt_w_ * excess : T(0.0);
    }
  }

 private:
  double sqrt_w_;
  std::vector<double> v_;
  Rgb limit_;
};

}  // namespace pbnbrdf
