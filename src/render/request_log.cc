#include "request_log.h"

#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {
namespace {

constexpr Rgb kWhite = {1.0, 1.0, 1.0};

}  // namespace

void RequestLog::AddLight(int material, const DirectionPair& pair, const Rgb& value,
                          const Rgb& arriving) {
  const Rgb reflectance = pair.wi.z * value;
  const Rgb change = (kWhite + reflectance) * arriving;
  Keep({material, pair, Luminance(reflectance * arriving), Luminance(change)});
}

void RequestLog::Continue(std::size_t path, int material, const DirectionPair& pair,
                          const Rgb& value, const Rgb& radiance) {
  reflections_.push_back({path, material, pair, value, radiance});
}

void RequestLog::EndPaths(std::span<const Path> paths) {
  for (const auto& [path, material, pair, value, radiance] : reflections_) {
    const Rgb later = paths[path].radiance - radiance, reflectance = pair.wi.z * value;
    Rgb change = {};
    for (std::size_t c = 0; c < 3; ++c) {
      if (reflectance[c] > 0.0) change[c] = later[c] * (1.0 + reflectance[c]) / reflectance[c];
    }
    Keep({material, pair, Luminance(later), Luminance(change)});
  }
  reflections_.clear();
}

void RequestLog::Keep(const Request& request) {
  const bool finite = std::isfinite(request.luminance) && std::isfinite(request.sensitivity);
  if (finite && request.sensitivity > 0.0) requests_.push_back(request);
}

}  // namespace pbnbrdf
