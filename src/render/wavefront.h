// wavefront.h: paths that are traced together, one step at a time [1].
//
// [1] S. Laine, T. Karras, T. Aila. Megakernels Considered Harmful: Wavefront Path Tracing on GPUs.
//     HPG 2013.
#pragma once

#include <vector>

#include "geometry.h"
#include "lights.h"
#include "path.h"
#include "request_log.h"
#include "statistics.h"

namespace pbnbrdf {

// What a ray of a path leads to.
struct RayEnd {
  enum class Kind { kNothing, kLight, kSurface };

  Kind kind = Kind::kNothing;  // kNothing: the path ends there and gets no light
  Rgb radiance = {};           // of the light
  double weight = 1.0;         // of the light, by multiple importance sampling
  Hit hit = {};                // on the surface
};

struct Wavefront {
  const Geometry& geometry;
  const Lights& lights;
  const RenderOptions& options;
  ThreadStatistics* stats = nullptr;
  RequestLog* log = nullptr;  // null: not wanted
  std::vector<Path> paths = {};
  int bounces = 0;                    // reflections before `vertices`
  std::vector<Vertex> vertices = {};  // that are being shaded
  std::vector<Vertex> reached = {};   // that are shaded next

  // What the ray leads to after so many reflections. pdf: the density, per solid angle, with which
  // the last of them chose the direction. trace: false if the ray is known to hit nothing.
  RayEnd Follow(const Ray& ray, int reflections, double pdf, bool trace = true) const;

  // Takes the path to the end of its ray: adds the light there, or the surface to `reached`.
  void Arrive(std::size_t path, const Ray& ray, const RayEnd& end);
};

}  // namespace pbnbrdf
