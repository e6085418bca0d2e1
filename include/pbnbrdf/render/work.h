// work.h: what a render did, and what it left out because the image doesn't depend on it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pbnbrdf/base/names.h"

namespace pbnbrdf {

enum class SkipReason {
  kUnreferenced,  // no shape has the material
  kNotReached,    // shapes have it, but no path got there
  kBelowHorizon,  // the direction is below the surface, or beyond the shading normal's horizon
  kOccluded,      // something is in front of the light
  kUnlit,         // no light comes from there, or none that counts: a black texel, the back of a
                  // rectangle light, a surface behind the last reflection
  kEmptyTiles,    // no shape or rectangle light can be seen through the camera ray's tile
  kEnded,         // the path had ended
  kConverged      // the pixel is known well enough (RenderOptions::target_error)
};

inline constexpr NameTable<SkipReason, 8> kSkipReasons = {
    {{"unreferenced", SkipReason::kUnreferenced},
     {"not_reached", SkipReason::kNotReached},
     {"below_horizon", SkipReason::kBelowHorizon},
     {"occluded", SkipReason::kOccluded},
     {"unlit", SkipReason::kUnlit},
     {"empty_tiles", SkipReason::kEmptyTiles},
     {"ended", SkipReason::kEnded},
     {"converged", SkipReason::kConverged}}};

// How often one kind of thing was done. What is skipped is never among what is needed: skipping
// what there is to skip, done = needed; skipping nothing, done is needed plus what was skipped.
struct Work {
  std::int64_t needed = 0;  // the image depends on it
  std::int64_t done = 0;
  std::array<std::int64_t, kSkipReasons.size()> skipped = {};  // by SkipReason
  double seconds = 0.0;  // that what was done took, summed over threads

  std::int64_t& Skipped(SkipReason reason) { return skipped[static_cast<std::size_t>(reason)]; }
  std::int64_t Skipped(SkipReason reason) const {
    return skipped[static_cast<std::size_t>(reason)];
  }
  std::int64_t AllSkipped() const;

  // What the skipped ones would have taken if each took the mean time of one that was done, of one
  // thread; nothing if none was done, so that there is no mean.
  std::optional<double> SecondsSavedEstimate() const;

  Work& operator+=(const Work& other);
};

struct RenderWork {
  Work materials;  // opened, and proposals fitted to them: unreferenced, not_reached
  Work samples;    // paths: converged
  // Steps of paths: one for the camera ray and one for each reflection, of a path that goes on.
  // `ended` counts those that a wavefront without compaction would drag along: paths that have
  // ended while others of the same call of PathTracer::Trace go on. It is a matter of comparison:
  // ended paths always leave, with RenderOptions::skip or without, and no time is put down to lanes.
  Work lanes;
  Work rays;         // camera, shadow, and reflected: below_horizon and unlit (shadow), empty_tiles
  Work brdf_values;  // below_horizon, occluded, unlit

  RenderWork& operator+=(const RenderWork& other);
};

}  // namespace pbnbrdf
