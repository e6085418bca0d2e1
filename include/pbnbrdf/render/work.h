// work.h: counts of the work of a render, and of the work that it skipped because the image does not
// depend on it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pbnbrdf/base/names.h"

namespace pbnbrdf {

enum class SkipReason {
  kUnreferenced,  // no shape has the material
  kNotReached,    // shapes have the material, but no path hit them
  kBelowHorizon,  // the direction is below the surface or below the shading normal's horizon
  kOccluded,      // something stands in front of the light
  kUnlit,         // no light that counts comes from there: a black texel, the back of a rectangle
                  // light, or a surface beyond the last reflection
  kEmptyTiles,    // the camera ray's tile shows neither a shape nor a rectangle light
  kEnded,         // the path had ended
  kConverged      // the pixel had reached RenderOptions::target_error
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

// Counts of one kind of work. Skipped work is never needed work: if all of it is skipped, done equals
// needed; if it is done all the same, done is needed plus what would have been skipped.
struct Work {
  std::int64_t needed = 0;  // the image depends on it
  std::int64_t done = 0;
  std::array<std::int64_t, kSkipReasons.size()> skipped = {};  // by SkipReason
  double seconds = 0.0;  // that the work done took, summed over threads

  std::int64_t& Skipped(SkipReason reason) { return skipped[static_cast<std::size_t>(reason)]; }
  std::int64_t Skipped(SkipReason reason) const {
    return skipped[static_cast<std::size_t>(reason)];
  }
  std::int64_t AllSkipped() const;

  // Seconds of one thread, if what was skipped takes as long on average as what was done. Empty if
  // none was done.
  std::optional<double> SecondsSavedEstimate() const;

  Work& operator+=(const Work& other);
};

struct RenderWork {
  Work materials;  // opened, and a proposal fitted
  Work samples;    // paths
  // Vertices of paths: the camera, and each reflection. kEnded counts the places that ended paths
  // would keep in a wavefront without compaction. It is for comparison only: ended paths always
  // leave the wavefront, with RenderOptions::skip on or off. No time is measured.
  Work path_vertices;
  Work rays;         // camera rays, shadow rays and reflected rays
  Work brdf_values;  // f(wi, wo) of one pair of directions

  RenderWork& operator+=(const RenderWork& other);
};

// One kind of work, for loops over all of them.
struct WorkKind {
  const char* name;  // the member's name
  Work RenderWork::*work;
  std::vector<SkipReason> reasons;  // for which it may be skipped
};

const std::vector<WorkKind>& WorkKinds();

}  // namespace pbnbrdf
