// affine.h: affine maps of space, x -> A x + b, as shapes and lights are placed by.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
// The vector must not be zero.
inline Vec3 Normalized(const Vec3& a) { return (1.0 / Length(a)) * a; }
inline bool IsFinite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
// The largest magnitude of the three; infinite if one isn't finite.
inline double LargestCoordinate(const Vec3& a) {
  if (!IsFinite(a)) return std::numeric_limits<double>::infinity();
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

struct Affine {
  // The columns of A: where the x, y and z axes go.
  std::array<Vec3, 3> axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  Vec3 origin;  // b

  static Affine Translation(const Vec3& offset);
  static Affine Scaling(const Vec3& factors);
  // Right-handed about the axis, which must not be zero; degrees.
  static Affine Rotation(const Vec3& axis, double degrees);

  Vec3 Vector(const Vec3& v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
  Vec3 Point(const Vec3& p) const { return origin + Vector(p); }

  double Determinant() const { return Dot(axes[0], Cross(axes[1], axes[2])); }
  // Of a map whose determinant isn't 0.
  Affine Inverse() const;
  // The inverse transposed A times n: normals go there, up to their length.
  Vec3 Normal(const Vec3& n) const;
};

// x -> after(before(x)).
Affine Compose(const Affine& after, const Affine& before);

}  // namespace pbnbrdf
