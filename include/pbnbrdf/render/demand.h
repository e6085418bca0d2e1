// demand.h: what a scene asks of its materials: which of them its image shows, how much, and at
// which angles.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pbnbrdf/brdf/angle_distribution.h"
#include "pbnbrdf/render/render.h"

namespace pbnbrdf {

struct DemandOptions {
  int paths = 1 << 20;  // about so many, or one for each pixel; >= 1
  // The film is made smaller, of the same proportions, if it has more pixels.
  int most_pixels = 65536;  // >= 1
  std::uint64_t seed = 1;
  int threads = 0;  // 0: one for each core; the result is the same
  int max_bounces = 64;
};

struct MaterialDemand {
  bool referenced = false;  // by a shape
  bool reached = false;     // by a path
  // Of the luminance of all paths the part that the material has reflected, first or later: where
  // light is reflected by several materials, the parts add up to more than 1.
  double share = 0.0;
  // To first order, by what part of itself the image's mean luminance grows for a growth of log(1 +
  // f cos_i), what fits are made of (eq. 6), the same at all pairs of directions. A dark material in
  // bright light has a small share, but not a small sensitivity.
  double sensitivity = 0.0;
  // Where; null if the share is 0. A pair of directions weighs the geometric mean of its parts in
  // the share and in the sensitivity: errors of fits lie between the same everywhere in log(1 + f
  // cos_i) and in proportion to f.
  std::shared_ptr<const AngleDistribution> angles;
};

// Follows paths as Render does, with the materials as `open` gives them, opened when a path gets
// there. One for each material of the scene. Throws Error as Render does.
std::vector<MaterialDemand> MeasureDemand(const Scene& scene, const MaterialOpener& open,
                                          const DemandOptions& options = {});

}  // namespace pbnbrdf
