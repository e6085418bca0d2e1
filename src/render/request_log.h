// request_log.h: the BRDF values that paths request, and how much each matters to the image.
#pragma once

#include <span>
#include <vector>

#include "path.h"

namespace pbnbrdf {

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

}  // namespace pbnbrdf
