// geometry.h: what rays hit, by Embree 3 (https://www.embree.org).
//
// Embree computes in single precision. Where a ray hits is therefore computed again here, from the
// shape that it hits, so that the point lies on the shape. Spheres are intersected in double
// precision.
#pragma once

#include <memory>

#include "mesh_checks.h"
#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

struct Ray {
  Vec3 origin, direction;  // of unit length
};

struct Hit {
  int light = -1;     // number of the rectangle light, or -1
  int material = -1;  // of the shape; -1 on a light
  Vec3 position;
  Vec3 normal;          // of the surface, of unit length
  Vec3 shading_normal;  // interpolated where the mesh has normals, of unit length
  Vec3 tangent;         // not of unit length, perhaps not in the surface
  double margin = 0.0;  // rays that leave the surface start at this distance from it
};

class Geometry {
 public:
  // The scene must outlive this.
  explicit Geometry(const Scene& scene);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  // The first hit of the ray; false if it hits nothing.
  bool Intersect(const Ray& ray, Hit* hit) const;

  // Whether the ray hits something nearer than `distance`, which may be infinite.
  bool Occluded(const Ray& ray, double distance) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace pbnbrdf
