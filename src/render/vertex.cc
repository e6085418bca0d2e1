#include "vertex.h"

#include <cmath>

namespace pbnbrdf {
namespace {

Frame MakeFrame(const Vec3& normal, const Vec3& tangent) {
  Vec3 x = tangent - Dot(tangent, normal) * normal;
  if (!(Length(x) > 1e-6 * Length(tangent))) {  // along the normal: any other will do
    const Vec3 other = std::abs(normal.x) < 0.5 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
    x = other - Dot(other, normal) * normal;
  }
  x = Normalized(x);
  return {x, Cross(normal, x), normal};
}

}  // namespace

Vertex MakeVertex(const Hit& hit, std::size_t path, const Vec3& direction) {
  const Vec3 to_viewer = -1.0 * direction;
  Vertex vertex;
  vertex.path = path;
  vertex.material = hit.material;
  vertex.position = hit.position;
  vertex.margin = hit.margin;
  vertex.normal = Dot(hit.normal, to_viewer) < 0.0 ? -1.0 * hit.normal : hit.normal;
  // An interpolated normal may be turned away from a viewer who sees the triangle.
  Vec3 shading =
      Dot(hit.shading_normal, vertex.normal) < 0.0 ? -1.0 * hit.shading_normal : hit.shading_normal;
  if (!(Dot(shading, to_viewer) > 0.0)) shading = vertex.normal;
  vertex.frame = MakeFrame(shading, hit.tangent);
  vertex.wo = vertex.frame.ToLocal(to_viewer);
  return vertex;
}

}  // namespace pbnbrdf
