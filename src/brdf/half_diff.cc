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

// The tangents of the frame of h: along growing theta_h and along growing phi_h.
struct Tangents {
  Vec3 theta, phi;
};

Tangents TangentsAt(double sin_theta, double cos_theta, double sin_phi, double cos_phi) {
  return {{cos_theta * cos_phi, cos_theta * sin_phi, -sin_theta}, {-sin_phi, cos_phi, 0.0}};
}

}  // namespace

HalfDiff ToHalfDiff(const DirectionPair& pair) {
  const Vec3 sum = pair.wi + pair.wo;
  const Vec3 difference = 0.5 * (pair.wi - pair.wo);
  const double length = Length(sum);
  const Vec3 h = length > 0.0 ? (1.0 / length) * sum : Vec3{0.0, 0.0, 1.0};
  const double sin_theta = std::hypot(h.x, h.y);
  const double cos_phi = sin_theta > 0.0 ? h.x / sin_theta : 1.0;
  const double sin_phi = sin_theta > 0.0 ? h.y / sin_theta : 0.0;
  const Tangents t = TangentsAt(sin_theta, h.z, sin_phi, cos_phi);
  return {h, {Dot(difference, t.theta), Dot(difference, t.phi), 0.5 * length}};
}

RusinkiewiczAngles ToAngles(const DirectionPair& pair) {
  const auto [h, d] = ToHalfDiff(pair);
  return {.theta_h = std::atan2(std::hypot(h.x, h.y), h.z),
          .theta_d = std::atan2(std::hypot(d.x, d.y), d.z),
          .phi_d = Azimuth(d.y, d.x),
          .phi_h = Azimuth(h.y, h.x)};
}

DirectionPair FromAngles(const RusinkiewiczAngles& angles) {
  const Vec3 h = FromSpherical(angles.theta_h, angles.phi_h);
  const Vec3 d = FromSpherical(angles.theta_d, angles.phi_d);
  const Tangents t =
      TangentsAt(std::sin(angles.theta_h), h.z, std::sin(angles.phi_h), std::cos(angles.phi_h));
  const Vec3 along = d.z * h;
  const Vec3 across = d.x * t.theta + d.y * t.phi;
  return {along + across, along - across};
}

}  // namespace pbnbrdf
