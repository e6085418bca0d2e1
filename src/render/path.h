// path.h: the state of a path, and the vertices where materials reflect it.
#pragma once

#include "geometry.h"
#include "random.h"
#include "rgb.h"

namespace pbnbrdf {

struct Path {
  std::size_t pixel = 0;  // of the image, row by row
  Random random;
  Rgb throughput = {1.0, 1.0, 1.0};  // product of f cos / pdf over the reflections so far
  Rgb radiance = {};                 // found so far
};

// A right-handed orthonormal frame; z is the normal.
struct Frame {
  Vec3 x, y, z;

  Vec3 ToLocal(const Vec3& v) const { return {Dot(v, x), Dot(v, y), Dot(v, z)}; }
  Vec3 ToWorld(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

// The normals are on the viewer's side.
struct Vertex {
  std::size_t path;
  int material;
  Vec3 position, normal;
  Frame frame;  // about the shading normal
  Vec3 wo;      // to the viewer, in the frame
  double margin;

  // A ray that leaves on the viewer's side.
  Ray RayTo(const Vec3& direction) const { return {position + margin * normal, direction}; }
};

// direction: in which the path has come to the hit.
Vertex MakeVertex(const Hit& hit, std::size_t path, const Vec3& direction);

}  // namespace pbnbrdf
