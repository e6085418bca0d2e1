// direction.h: unit vectors of the shading frame (normal = +z) and pairs of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace pbnbrdf {

struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  bool operator==(const Vec3&) const = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double Dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double Length(const Vec3& a) { return std::sqrt(Dot(a, a)); }

// (sin theta cos phi, sin theta sin phi, cos theta); radians.
inline Vec3 FromSpherical(double theta, double phi) {
  const double s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

// The angle to the normal, in [0, pi]; exact near the pole, where acos isn't.
inline double Theta(const Vec3& a) { return std::atan2(std::hypot(a.x, a.y), a.z); }

// Linear R, G, B.
using Rgb = std::array<double, 3>;

inline double Largest(const Rgb& rgb) { return std::max({rgb[0], rgb[1], rgb[2]}); }

// wi points to the light, wo to the viewer; both of unit length.
struct DirectionPair {
  Vec3 wi, wo;

  bool AboveHorizon() const { return wi.z > 0.0 && wo.z > 0.0; }
};

// cos theta_i as the loss terms take it: clamped to [0, 1].
inline double CosI(const DirectionPair& pair) { return std::clamp(pair.wi.z, 0.0, 1.0); }

inline DirectionPair Swapped(const DirectionPair& pair) { return {pair.wo, pair.wi}; }

}  // namespace pbnbrdf
