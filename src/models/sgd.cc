#include "pbnbrdf/models/sgd.h"

#include <algorithm>
#include <cmath>

#include "base/pi.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

double Fresnel(const SgdParameters& m, double u) {
  return m.f0 + (1.0 - m.f0) * std::pow(1.0 - u, 5) - m.f1 * u;
}

double Distribution(const SgdParameters& m, double tan2, double cos2) {
  const double x = m.alpha + tan2 / m.alpha;
  return m.kappa * std::exp(-x) / (kPi * std::pow(x, m.p) * cos2 * cos2);
}

double Shadowing(const SgdParameters& m, double theta) {
  const double excess = theta - m.theta_0;
  if (excess <= 0.0) return 1.0;
  return std::clamp(1.0 + m.lambda * (1.0 - std::exp(m.c * std::pow(excess, m.k))), 0.0, 1.0);
}

}  // namespace

std::string SgdBrdf::Description() const {
  return StrCat("SGD model of ", name_, " (Bagher et al. 2012)");
}

Rgb SgdBrdf::Value(const DirectionPair& pair) const {
  const auto& [wi, wo] = pair;
  const Vec3 sum = wi + wo;
  const double length = Length(sum);
  // tan^2 from the unnormalised half vector: 1 - cos^2 would lose the digits of narrow lobes.
  const double tan2 = (sum.x * sum.x + sum.y * sum.y) / (sum.z * sum.z);
  const double cos_h = sum.z / length;
  const double u = std::min(0.5 * length, 1.0);
  const double theta_i = std::acos(std::min(wi.z, 1.0));
  const double theta_o = std::acos(std::min(wo.z, 1.0));
  Rgb value;
  for (int c = 0; c < 3; ++c) {
    const SgdParameters& m = channels_[c];
    const double shadowing = Shadowing(m, theta_i) * Shadowing(m, theta_o);
    const double specular =
        Fresnel(m, u) * Distribution(m, tan2, cos_h * cos_h) * shadowing / (wi.z * wo.z);
    value[c] = (m.rho_d + m.rho_s * specular) / kPi;
  }
  return value;
}

}  // namespace pbnbrdf
