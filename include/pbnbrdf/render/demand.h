// demand.h: what the image of a scene asks of its materials: which of them it shows, how much each
// matters, and at which angles.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pbnbrdf/brdf/angle_distribution.h"
#include "pbnbrdf/render/render.h"

namespace pbnbrdf {

struct DemandOptions {
  int paths = 1 << 20;     // about so many, but at least one for each pixel; >= 1
  int max_pixels = 65536;  // a larger film is scaled down to this; >= 1
  std::uint64_t seed = 1;
  int threads = 0;  // 0: one for each core; the result does not depend on it
  int max_bounces = 64;
};

struct MaterialDemand {
  bool referenced = false;  // by a shape
  bool reached = false;     // by a path
  // The part of the image's luminance that this material reflects, at any vertex of its path. The
  // shares of all materials may add up to more than 1, as several reflect the same light.
  double share = 0.0;
  // d log(L) / d log(1 + f cos_i), for the image's mean luminance L and the same change at all pairs
  // of directions. Fits minimise errors of log(1 + f cos_i) (eq. 6), so this says how much such an
  // error shows. A dark material in bright light has a small share, but not a small sensitivity.
  double sensitivity = 0.0;
  // Where: a distribution of pairs of directions, each weighted by the geometric mean of its parts in
  // share and sensitivity. Errors of fits lie between errors that are the same everywhere in
  // log(1 + f cos_i) and errors in proportion to f. Null if the share is 0.
  std::shared_ptr<const AngleDistribution> angles;
};

// Traces paths as Render does. Returns the demand for each material of the scene. Materials are
// opened when a path hits them. Throws Error as Render does, and if an option is out of its range.
std::vector<MaterialDemand> MeasureDemand(const Scene& scene, const MaterialOpener& open,
                                          const DemandOptions& options = {});

}  // namespace pbnbrdf
