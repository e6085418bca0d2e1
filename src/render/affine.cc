#include "pbnbrdf/render/affine.h"

#include <numbers>

namespace pbnbrdf {

Affine Affine::Translation(const Vec3& offset) { return {.origin = offset}; }

Affine Affine::Scaling(const Vec3& factors) {
  return {.axes = {{{factors.x, 0.0, 0.0}, {0.0, factors.y, 0.0}, {0.0, 0.0, factors.z}}}};
}

Affine Affine::Rotation(const Vec3& axis, double degrees) {
  const Vec3 k = Normalized(axis);
  const double angle = degrees * std::numbers::pi / 180.0;
  const double c = std::cos(angle), s = std::sin(angle);
  Affine map;
  // Rodrigues' formula.
  for (Vec3& v : map.axes) v = c * v + s * Cross(k, v) + (Dot(k, v) * (1.0 - c)) * k;
  return map;
}

Affine Affine::Inverse() const {
  const double scale = 1.0 / Determinant();
  const Vec3 r0 = scale * Cross(axes[1], axes[2]), r1 = scale * Cross(axes[2], axes[0]),
             r2 = scale * Cross(axes[0], axes[1]);  // rows of the inverse of A
  Affine inverse;
  inverse.axes = {{{r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}}};
  inverse.origin = -1.0 * inverse.Vector(origin);
  return inverse;
}

Vec3 Affine::Normal(const Vec3& n) const {
  return (1.0 / Determinant()) * (n.x * Cross(axes[1], axes[2]) + n.y * Cross(axes[2], axes[0]) +
                                  n.z * Cross(axes[0], axes[1]));
}

Affine Compose(const Affine& after, const Affine& before) {
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) map.axes[i] = after.Vector(before.axes[i]);
  map.origin = after.Point(before.origin);
  return map;
}

}  // namespace pbnbrdf
