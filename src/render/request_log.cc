#include "request_log.h"

#include <cmath>

#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {

void RequestLog::AddLight(int material, const DirectionPair& pair, const Rgb& value,
                          const Rgb& arriving) {
  const double cos_i = pair.wi.z;
  Rgb reflected, change;
  for (std::size_t c = 0; c < 3; ++c) {
    reflected[c] = value[c] * cos_i * arriving[c];
    change[c] = (1.0 + value[c] * cos_i) * arriving[c];
  }
  Keep({material, pair, Luminance(reflected), Luminance(change)});
}

void RequestLog::Keep(const Request& request) {
  const bool finite = std::isfinite(request.luminance) && std::isfinite(request.sensitivity);
  if (finite && request.sensitivity > 0.0) requests_.push_back(request);
}

void RequestLog::GoOn(std::size_t path, int material, const DirectionPair& pair, const Rgb& value,
                      const Rgb& radiance) {
  onward_.push_back({path, material, pair, value, radiance});
}

void RequestLog::EndPaths(std::span<const Rgb> radiance) {
  for (const Onward& onward : onward_) {
    Rgb later, change = {};
    for (std::size_t c = 0; c < 3; ++c) {
      later[c] = radiance[onward.path][c] - onward.radiance[c];
      const double reflected = onward.value[c] * onward.pair.wi.z;
      if (reflected > 0.0) change[c] = later[c] * (1.0 + reflected) / reflected;
    }
    Keep({onward.material, onward.pair, Luminance(later), Luminance(change)});
  }
  onward_.clear();
}

}  // namespace pbnbrdf
