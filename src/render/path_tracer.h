// path_tracer.h: traces paths through blocks of pixels and adds them to the image.
#pragma once

#include <span>

#include "base/per_thread.h"
#include "camera.h"
#include "materials.h"
#include "pixels.h"
#include "reflection.h"

namespace pbnbrdf {

// The samples first, ..., first + count - 1 of each pixel of the blocks.
struct SampleRange {
  std::span<const PixelBlock> blocks;
  int first, count;
  bool empty = false;  // the blocks' tile is empty (camera.h)
};

class PathTracer {
 public:
  // All must outlive this.
  PathTracer(const Scene& scene, const RenderOptions& options, Materials* materials);

  // Adds the samples to pixels, which are those of the whole image, and returns their number. log:
  // null, or where the BRDF requests of the paths go. May be called by several threads for
  // different blocks, with different logs.
  std::int64_t Trace(const SampleRange& range, std::span<PixelSum> pixels, Statistics* statistics,
                     RequestLog* log = nullptr) const;

  const PinholeCamera& camera() const { return camera_; }

 private:
  // What a thread works with. It is kept from call to call, as getting memory anew takes longer.
  struct Worker {
    Wavefront wave;
    BrdfBatch batch = {};
    DirectLight direct_light = {};
    Scattering scattering = {};
  };

  void StartPaths(const SampleRange& range, Wavefront* wave) const;
  void StartPath(int x, int y, int sample, bool empty, Wavefront* wave) const;
  void ShadeVertices(Worker* worker) const;
  const PreparedMaterial* OpenMaterial(int material, ThreadStatistics* stats) const;

  const RenderOptions& options_;
  Materials& materials_;
  const Film film_;
  const PinholeCamera camera_;
  const Geometry geometry_;
  const Lights lights_;
  mutable PerThread<Worker> workers_;
};

}  // namespace pbnbrdf
