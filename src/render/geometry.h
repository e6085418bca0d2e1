// geometry.h: what rays hit, by Embree 3 (https://www.embree.org).
//
// Embree computes in single precision. Where a ray hits is computed again here, from what is hit,
// so that the point lies on it; spheres are intersected in double precision altogether.
#pragma once

#include <memory>

#include "pbnbrdf/render/scene.h"

namespace pbnbrdf {

// What Embree is off by, relative to the coordinates, and directions in radians: a few roundings of
// float.
inline constexpr double kSinglePrecision = 1e-6;

struct Ray {
  Vec3 origin, direction;  // of unit length
};

struct Hit {
  int light = -1;     // the rectangle light's number, or -1, and then:
  int material = -1;  // the shape's
  Vec3 position;
  Vec3 normal;          // of the surface, of unit length
  Vec3 shading_normal;  // interpolated where the mesh has normals
  Vec3 tangent;         // any length, in the surface or not
  double margin;        // rays that start here need this distance from the surface
};

class Geometry {
 public:
  // The scene must outlive this.
  explicit Geometry(const Scene& scene);
  ~Geometry();
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  // The first thing that the ray meets; false if there is none.
  bool Intersect(const Ray& ray, Hit* hit) const;

  // Whether something is nearer than `distance`, which may be infinite.
  bool Occluded(const Ray& ray, double distance) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace pbnbrdf
