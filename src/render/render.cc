#include "pbnbrdf/render/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include "path_tracer.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/scaled.h"

namespace pbnbrdf {
namespace {

constexpr int kTileSize = 16;
constexpr int kMostSamples = 1 << 24;
constexpr int kMostBounces = 100000;

// So many samples of each of a tile's pixels at a time: thousands of paths keep networks busy.
constexpr int kSamplesAtOnce = 16;

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

OpenMaterial Open(const SceneMaterial& material, const MaterialOpener& open) try {
  OpenMaterial opened;
  opened.brdf = open(material.source);
  double factor = 1.0;
  if (material.scale_to_albedo > 0.0) {
    factor = material.scale_to_albedo / LargestAlbedo(*opened.brdf);
    if (!std::isfinite(factor)) Fail("can't be scaled to an albedo of ", material.scale_to_albedo);
  }
  if (auto single = opened.brdf->SinglePrecision()) opened.brdf = std::move(single);
  if (factor != 1.0) opened.brdf = std::make_unique<ScaledBrdf>(std::move(opened.brdf), factor);
  opened.sampler = std::make_unique<ImportanceSampler>(*opened.brdf);
  return opened;
} catch (const Error& error) {
  Fail("materials.", material.name, ": ", error.what());
}

std::vector<OpenMaterial> OpenNeeded(const Scene& scene, const MaterialOpener& open) {
  std::vector<OpenMaterial> materials(scene.materials.size());
  for (const Shape& shape : scene.shapes) {
    OpenMaterial& material = materials[std::size_t(shape.material)];
    if (!material.brdf) material = Open(scene.materials[std::size_t(shape.material)], open);
  }
  return materials;
}

std::vector<Tile> TilesOf(const Film& film) {
  std::vector<Tile> tiles;
  for (int y = 0; y < film.height; y += kTileSize) {
    for (int x = 0; x < film.width; x += kTileSize) {
      tiles.push_back(
          {x, y, std::min(kTileSize, film.width - x), std::min(kTileSize, film.height - y)});
    }
  }
  return tiles;
}

// Renders tile by tile until all samples are there or the caller has had enough.
class Renderer {
 public:
  Renderer(const Scene& scene, const PathTracer& tracer, const RenderOptions& options)
      : scene_(scene),
        tracer_(tracer),
        options_(options),
        tiles_(TilesOf(scene.film)),
        counts_(tiles_.size()),
        pixels_(std::size_t(scene.film.width) * std::size_t(scene.film.height)) {}

  void Run(tbb::task_arena* arena) {
    // One sample of every pixel first: an early stop leaves a picture, too.
    for (int done = 0, count = 1; done < options_.samples_per_pixel && !stopped_; done += count) {
      if (done > 0) count = std::min(kSamplesAtOnce, options_.samples_per_pixel - done);
      arena->execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, tiles_.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
              for (std::size_t i = range.begin(); i != range.end(); ++i) {
                TraceTile(i, done, count);
              }
            },
            tbb::simple_partitioner());
      });
    }
  }

  Rendering Result() const {
    Rendering result;
    result.image = Image(scene_.film.width, scene_.film.height);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const PixelSum& pixel = pixels_[i];
      result.summary.samples += pixel.samples;
      if (pixel.samples == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        // The mean of finite values may yet be too large for a float.
        const double mean = pixel.radiance[c] / static_cast<double>(pixel.samples);
        result.image.rgb[3 * i + c] =
            static_cast<float>(std::min(mean, double(std::numeric_limits<float>::max())));
      }
    }
    for (const TileCounts& counts : counts_) {
      result.summary.dropped_samples += counts.dropped_samples;
      result.summary.brdf_values += counts.brdf_values;
      result.summary.rays += counts.rays;
    }
    result.summary.stopped = stopped_;
    result.summary.seconds = SecondsSince(start_);
    return result;
  }

 private:
  void TraceTile(std::size_t number, int first, int count) {
    if (stopped_) return;
    const Tile& tile = tiles_[number];
    tracer_.Trace(tile, first, count, pixels_, &counts_[number]);
    if (!options_.on_progress) return;
    const std::lock_guard lock(progress_mutex_);
    samples_done_ += std::int64_t(tile.width) * tile.height * count;
    const double all = double(pixels_.size()) * options_.samples_per_pixel;
    if (!options_.on_progress({double(samples_done_) / all, SecondsSince(start_)})) stopped_ = true;
  }

  const Scene& scene_;
  const PathTracer& tracer_;
  const RenderOptions& options_;
  const Clock::time_point start_ = Clock::now();
  const std::vector<Tile> tiles_;
  std::vector<TileCounts> counts_;
  std::vector<PixelSum> pixels_;
  std::atomic<bool> stopped_ = false;
  std::mutex progress_mutex_;
  std::int64_t samples_done_ = 0;
};

}  // namespace

void ValidateRender(const RenderOptions& options) {
  const auto check = [](const char* name, int value, int least, int most) {
    if (value < least || value > most) {
      Fail("RenderOptions::", name, " = ", value, "; must be ", least, " to ", most);
    }
  };
  check("samples_per_pixel", options.samples_per_pixel, 1, kMostSamples);
  check("max_bounces", options.max_bounces, 0, kMostBounces);
  if (options.threads < 0) Fail("RenderOptions::threads = ", options.threads, "; must be >= 0");
}

Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options) {
  ValidateRender(options);
  const int most_threads = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most_threads)
                                            : most_threads);
  std::vector<OpenMaterial> materials;
  arena.execute([&] { materials = OpenNeeded(scene, open); });
  const Geometry geometry(scene);
  const PathTracer tracer(scene, geometry, materials, options);
  Renderer renderer(scene, tracer, options);
  renderer.Run(&arena);
  Rendering rendering = renderer.Result();
  rendering.summary.materials_opened = static_cast<int>(std::count_if(
      materials.begin(), materials.end(), [](const auto& m) { return bool(m.brdf); }));
  return rendering;
}

}  // namespace pbnbrdf
