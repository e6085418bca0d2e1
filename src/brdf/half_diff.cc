#include "pbnbrdf/brdf/half_diff.h"

#include <numbers>

namespace pbnbrdf {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

// atan2 in [0, 2 pi).
double Azimuth(double y, double x) {
  const double phi = std::atan2(y, x);
  const double turned = phi < 0.0 ? phi + kTwoPi : phi;
  return turned < kTwoPi ? turned : 0.0;
}

}  // namespace

HalfDiff ToHalfDiff(const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  const auto v = HalfDiffFromPair<double>({wi.x, wi.y, wi.z}, {wo.x, wo.y, wo.z});
  return {{v.hx, v.hy, v.cos_theta}, {v.dx, v.dy, v.dz}};
}

RusinkiewiczAngles ToAngles(const DirectionPair& pair) {
  const auto [h, d] = ToHalfDiff(pair);
  return {.theta_h = Theta(h),
          .theta_d = Theta(d),
          .phi_d = Azimuth(d.y, d.x),
          .phi_h = Azimuth(h.y, h.x)};
}

DirectionPair FromAngles(const RusinkiewiczAngles& angles) {
  const Vec3 h = FromSpherical(angles.theta_h, angles.phi_h);
  const Vec3 d = FromSpherical(angles.theta_d, angles.phi_d);
  const double sin_theta = std::sin(angles.theta_h), cos_phi = std::cos(angles.phi_h);
  const double sin_phi = std::sin(angles.phi_h);
  const Vec3 along_theta = {h.z * cos_phi, h.z * sin_phi, -sin_theta};
  const Vec3 along_phi = {-sin_phi, cos_phi, 0.0};
  const Vec3 along = d.z * h;
  const Vec3 across = d.x * along_theta + d.y * along_phi;
  return {along + across, along - across};
}

}  // namespace pbnbrdf
