// request_log.h: what paths ask materials for, and what the image makes of the answers.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// f(pair) of a material, once, as a path asks for it.
struct Request {
  int material;
  DirectionPair pair;
  double luminance;    // that came to the path through this reflection
  double sensitivity;  // change of luminance by a change of log(1 + f cos_i), to first order
};

// Of the paths of one call of PathTracer::Trace.
class RequestLog {
 public:
  explicit RequestLog(std::vector<Request>* requests) : requests_(*requests) {}

  // A light is reflected once: it adds value * cos_i * arriving to the path.
  void AddLight(int material, const DirectionPair& pair, const Rgb& value, const Rgb& arriving);

  // The path goes on, having found `radiance` so far: what it finds later comes by this way.
  void GoOn(std::size_t path, int material, const DirectionPair& pair, const Rgb& value,
            const Rgb& radiance);

  // What each of the paths has found in all.
  void EndPaths(std::span<const Rgb> radiance);

 private:
  // Unless nothing depends on it, or its path is to be dropped.
  void Keep(const Request& request);

  struct Onward {
    std::size_t path;
    int material;
    DirectionPair pair;
    Rgb value, radiance;
  };

  std::vector<Request>& requests_;
  std::vector<Onward> onward_;
};

}  // namespace pbnbrdf
