// rgl_square.h: the unit square of half vectors on which the tables of RGL files (rgl.h) lie.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/pi.h"
#include "pbnbrdf/brdf/direction.h"
#include "sources/warp_tables.h"

namespace pbnbrdf {

// theta of a unit vector, exact near the pole, where acos isn't.
inline double Elevation(const Vec3& w) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * Length(w - Vec3{0.0, 0.0, 1.0})));
}

inline double Azimuth(const Vec3& w) { return std::atan2(w.y, w.x); }

// x, y: of theta in [0, pi/2] and of phi.
inline double ElevationColumn(double theta) { return std::sqrt(2.0 * theta / std::numbers::pi); }
inline double AzimuthRow(double phi) {
  const double v = (phi + std::numbers::pi) / (2.0 * std::numbers::pi);
  return v - std::floor(v);
}

// The direction at a point; turn: what its azimuth is counted from.
inline Vec3 DirectionAt(const SquarePoint& point, double turn) {
  return FromSpherical(0.5 * kPi * point.x * point.x, (2.0 * point.y - 1.0) * kPi + turn);
}

// wo, given wi and the half vector.
inline Vec3 ReflectedAt(const Vec3& wi, const Vec3& half) {
  return 2.0 * Dot(wi, half) * half - wi;
}

}  // namespace pbnbrdf
