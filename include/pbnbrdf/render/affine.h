// affine.h: affine maps x -> A x + b, which place shapes and lights in the scene.
#pragma once

#include <array>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// The vector must not be zero.
inline Vec3 Normalized(const Vec3& a) { return (1.0 / Length(a)) * a; }

struct Affine {
  // The columns of A: where the x, y and z axes go.
  std::array<Vec3, 3> axes = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  Vec3 origin = {};  // b

  static Affine Translation(const Vec3& offset);
  static Affine Scaling(const Vec3& factors);
  // Right-handed, about an axis that is not zero.
  static Affine Rotation(const Vec3& axis, double degrees);

  Vec3 Vector(const Vec3& v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
  Vec3 Point(const Vec3& p) const { return origin + Vector(p); }
  double Determinant() const { return Dot(axes[0], Cross(axes[1], axes[2])); }

  // The determinant must not be 0.
  Affine Inverse() const;
  // The inverse transposed A times n, the direction of a transformed normal; not of unit length.
  Vec3 Normal(const Vec3& n) const;
};

// x -> after(before(x)).
Affine Compose(const Affine& after, const Affine& before);

}  // namespace pbnbrdf
