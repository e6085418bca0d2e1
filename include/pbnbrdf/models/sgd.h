// sgd.h: the shifted gamma distribution model [1], fitted by its authors to the MERL materials.
//
// For each channel, with u = wi.h,
//   f     = (rho_d + rho_s F(u) D(theta_h) G1(theta_i) G1(theta_o) / (cos_i cos_o)) / pi
//   D     = kappa exp(-x) / (pi x^p cos^4 theta_h),  x = alpha + tan^2 theta_h / alpha
//   F     = f0 + (1 - f0) (1 - u)^5 - f1 u
//   G1(t) = clamp(1 + lambda (1 - exp(c max(0, t - theta_0)^k)), 0, 1)
//
// [1] M. Bagher, C. Soler, N. Holzschuch. Accurate fitting of measured reflectances using a Shifted
//     Gamma micro-facet distribution. Computer Graphics Forum 31(4), 2012.
#pragma once

#include <array>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// One channel's parameters, named as in [1].
struct SgdParameters {
  double rho_d = 0.0, rho_s = 0.0;
  double alpha = 1.0, p = 0.0;
  double f0 = 0.0, f1 = 0.0;
  double kappa = 0.0;
  double lambda = 0.0, c = 0.0, k = 0.0, theta_0 = 0.0;
};

class SgdBrdf final : public PointwiseBrdf {
 public:
  SgdBrdf(std::string name, const std::array<SgdParameters, 3>& channels)
      : name_(std::move(name)), channels_(channels) {}

  std::string Description() const override;

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  std::string name_;
  std::array<SgdParameters, 3> channels_;
};

}  // namespace pbnbrdf
