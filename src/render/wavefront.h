// wavefront.h: paths that are traced together, one step at a time [1], and a log of the BRDF values that they
// request.
//
// [1] S. Laine, T. Karras, T. Aila. Megakernels Considered Harmful: Wavefront Path Tracing on GPUs.
//     HPG 2013.
#pragma once

#include <span>
#include <vector>

#include "geometry.h"
#include "lights.h"
#include "random.h"
#include "rgb.h"
#include "statistics.h"

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

// One value f(pair) of a material, as one path requests it.
struct Request {
  int material;
  DirectionPair pair;
  double luminance;    // that the path gets by this reflection
  double sensitivity;  // d luminance / d log(1 + f cos_i)
};

// Of the paths of one call of PathTracer::Trace.
class RequestLog {
 public:
  explicit RequestLog(std::vector<Request>* requests) : requests_(*requests) {}

  // A light is reflected: it adds value * cos_i * arriving to the path's radiance.
  void AddLight(int material, const DirectionPair& pair, const Rgb& value, const Rgb& arriving);

  // The path goes on. `radiance` is what it has found so far: all that it finds later comes by this
  // reflection.
  void Continue(std::size_t path, int material, const DirectionPair& pair, const Rgb& value,
                const Rgb& radiance);

  // All paths have ended.
  void EndPaths(std::span<const Path> paths);

 private:
  struct Reflection {
    std::size_t path;
    int material;
    DirectionPair pair;
    Rgb value, radiance;
  };

  // Unless the image does not depend on it, or the path is dropped.
  void Keep(const Request& request);

  std::vector<Request>& requests_;
  std::vector<Reflection> reflections_;
};

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
