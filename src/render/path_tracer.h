// path_tracer.h: paths through blocks of pixels, all of which take their next step together.
#pragma once

#include <span>
#include <vector>

#include "camera.h"
#include "geometry.h"
#include "lights.h"
#include "materials.h"
#include "pbnbrdf/render/render.h"
#include "pixels.h"
#include "request_log.h"
#include "tiles.h"

namespace pbnbrdf {

struct TileCounts {
  std::int64_t dropped_samples = 0;
  RenderWork work;
};

// Which samples to take: first, ..., first + count - 1 of each pixel of the blocks.
struct SampleRange {
  std::span<const PixelBlock> blocks;
  int first, count;
  bool empty = false;  // the blocks are of a tile that is
};

class PathTracer {
 public:
  // All must outlive this.
  PathTracer(const Scene& scene, const PinholeCamera& camera, const Geometry& geometry,
             const RenderOptions& options, Materials* materials);

  // Adds the samples to pixels, which are those of the whole image, and what materials are asked for
  // to the log, if there is one. May be called for several sets of blocks at once, with logs of
  // their own.
  void Trace(const SampleRange& range, std::span<PixelSum> pixels, TileCounts* counts,
             RequestLog* log = nullptr) const;

 private:
  friend class TilePaths;

  const Scene& scene_;
  const PinholeCamera& camera_;
  const Geometry& geometry_;
  const RenderOptions& options_;
  Materials& materials_;
  const Lights lights_;
};

}  // namespace pbnbrdf
