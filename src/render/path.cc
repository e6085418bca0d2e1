#include "path.h"

#include <cmath>

namespace pbnbrdf {
namespace {

// A tangent nearer to the normal than this, in radians, is mostly rounding.
constexpr double kMinAngle = 1e-6;

Frame MakeFrame(const Vec3& normal, const Vec3& tangent) {
  Vec3 x = tangent - Dot(tangent, normal) * normal;
  if (!(Length(x) > kMinAngle * Length(tangent))) {
    const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    x = other - Dot(other, normal) * normal;
  }
  x = Normalized(x);
  return {x, Cross(normal, x), normal};
}

}  // namespace

Vertex MakeVertex(const Hit& hit, std::size_t path, const Vec3& direction) {
  const Vec3 to_viewer = -1.0 * direction;
  const auto towards = [](const Vec3& side, const Vec3& v) {
    return Dot(v, side) < 0.0 ? -1.0 * v : v;
  };
  const Vec3 normal = towards(to_viewer, hit.normal);
  Vec3 shading_normal = towards(normal, hit.shading_normal);
  // Interpolation may turn it away from a viewer who sees the triangle.
  if (!(Dot(shading_normal, to_viewer) > 0.0)) shading_normal = normal;
  const Frame frame = MakeFrame(shading_normal, hit.tangent);
  return {path, hit.material, hit.position, normal, frame, frame.ToLocal(to_viewer), hit.margin};
}

}  // namespace pbnbrdf
