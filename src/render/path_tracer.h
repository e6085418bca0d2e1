// path_tracer.h: the paths of a tile of the image, all of which take their next step together.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geometry.h"
#include "lights.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/render/render.h"
#include "random.h"

namespace pbnbrdf {

struct OpenMaterial {
  std::unique_ptr<Brdf> brdf;  // null: no shape has it
  std::unique_ptr<ImportanceSampler> sampler;
};

struct PixelSum {
  Rgb radiance = {};
  std::int64_t samples = 0;  // in the sum
};

struct Tile {
  int x, y, width, height;
};

struct TileCounts {
  std::int64_t dropped_samples = 0, brdf_values = 0, rays = 0;
};

class PathTracer {
 public:
  // All must outlive this.
  PathTracer(const Scene& scene, const Geometry& geometry,
             const std::vector<OpenMaterial>& materials, const RenderOptions& options);

  // Adds the samples first, ..., first + count - 1 of each of the tile's pixels, to pixels, which
  // are those of the whole image. May be called for several tiles at once.
  void Trace(const Tile& tile, int first, int count, std::span<PixelSum> pixels,
             TileCounts* counts) const;

 private:
  friend class TilePaths;

  Ray CameraRay(int x, int y, Random* random) const;

  const Scene& scene_;
  const Geometry& geometry_;
  const std::vector<OpenMaterial>& materials_;
  const RenderOptions& options_;
  const Lights lights_;
  Vec3 forward_, right_, up_;  // of the camera; the image's half sides at distance 1
};

}  // namespace pbnbrdf
