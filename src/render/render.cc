#include "pbnbrdf/render/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel.h"
#include "camera.h"
#include "path_tracer.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Far more than anyone waits for.
constexpr int kMaxSamples = 1 << 24, kMaxBounces = 100000;

// Samples that each pixel of a tile gets in one pass: 16 x 16 x 16 paths at a time keep networks
// busy with large batches.
constexpr int kSamplesPerPass = 16;

class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Materials* materials)
      : film_(scene.film),
        options_(options),
        materials_(*materials),
        tracer_(scene, options, materials),
        statistics_(options.skip),
        pixels_(std::size_t(film_.width) * std::size_t(film_.height)) {
    const int side = options.target_error > 0.0 ? kConvergenceBlock : kTileSize;
    for (const Tile& tile : TilesOf(scene, tracer_.camera())) {
      tiles_.push_back({Cut(tile.block, side), tile.empty});
    }
  }

  void Run() {
    // The first pass takes one sample of each pixel, so that an early stop leaves a whole image.
    for (int done = 0, count = 1; done < options_.samples_per_pixel && !Finished(); done += count) {
      if (done > 0) count = std::min(kSamplesPerPass, options_.samples_per_pixel - done);
      ParallelFor(tiles_.size(), [&](std::size_t i) { TraceTile(done, count, &tiles_[i]); });
      materials_.ThrowIfFailed();
    }
  }

  Rendering Result() const {
    Rendering result;
    RenderSummary& summary = result.summary;
    result.image = Image(film_.width, film_.height);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const PixelSum& pixel = pixels_[i];
      result.samples.push_back(pixel.samples);
      summary.samples += pixel.samples;
      if (pixel.samples == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        // The mean of finite values may still be too large for a float.
        const double mean = pixel.radiance[c] / static_cast<double>(pixel.samples);
        result.image.rgb[3 * i + c] =
            static_cast<float>(std::min(mean, double(std::numeric_limits<float>::max())));
      }
    }
    summary.work = statistics_.Sum();
    summary.work.materials = materials_.Count();
    summary.dropped_samples = summary.work.samples.done - summary.samples;
    summary.stopped = stopped_;
    return result;
  }

 private:
  struct TileState {
    std::vector<PixelBlock> blocks;  // that get more samples
    bool empty;                      // as in Tile
  };

  bool Finished() const {
    return stopped_ || std::all_of(tiles_.begin(), tiles_.end(),
                                   [](const TileState& tile) { return tile.blocks.empty(); });
  }

  void TraceTile(int first, int count, TileState* tile) {
    if (stopped_ || tile->blocks.empty()) return;
    std::int64_t samples =
        tracer_.Trace({tile->blocks, first, count, tile->empty}, pixels_, &statistics_);
    if (options_.target_error > 0.0) {
      const std::int64_t saved =
          RemoveConverged(pixels_, film_.width, options_.target_error, &tile->blocks) *
          (options_.samples_per_pixel - first - count);
      statistics_.OfThisThread().LeftOut(&RenderWork::samples, SkipReason::kConverged, saved);
      samples += saved;
    }
    ReportProgress(samples);
  }

  // samples: that were taken, or became unnecessary, since the thread's last report.
  void ReportProgress(std::int64_t samples) {
    if (!options_.on_progress) return;
    const std::lock_guard lock(progress_mutex_);
    samples_done_ += samples;
    const double all = double(pixels_.size()) * options_.samples_per_pixel;
    if (!options_.on_progress({double(samples_done_) / all, timer_.Seconds()})) stopped_ = true;
  }

  const Film film_;
  const RenderOptions& options_;
  Materials& materials_;
  const PathTracer tracer_;
  Statistics statistics_;
  std::vector<TileState> tiles_;
  std::vector<PixelSum> pixels_;
  std::atomic<bool> stopped_ = false;
  std::mutex progress_mutex_;
  std::int64_t samples_done_ = 0;
  const Timer timer_;
};

}  // namespace

void ValidateRender(const RenderOptions& options) {
  const auto check = [](const char* name, int value, int min, int max) {
    if (value < min || value > max) {
      Fail("RenderOptions::", name, " = ", value, "; must be ", min, " to ", max);
    }
  };
  check("samples_per_pixel", options.samples_per_pixel, 1, kMaxSamples);
  check("max_bounces", options.max_bounces, 0, kMaxBounces);
  if (options.threads < 0) Fail("RenderOptions::threads = ", options.threads, "; must be >= 0");
  if (!(options.target_error >= 0.0) || !std::isfinite(options.target_error)) {
    Fail("RenderOptions::target_error = ", options.target_error, "; must be finite and >= 0");
  }
}

Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options) {
  ValidateRender(options);
  const Timer timer;
  Materials materials(scene, open);
  if (!options.skip) WithThreads(options.threads, [&] { materials.OpenAll(); });
  Renderer renderer(scene, options, &materials);
  WithThreads(options.threads, [&] { renderer.Run(); });
  Rendering rendering = renderer.Result();
  rendering.summary.seconds = timer.Seconds();
  return rendering;
}

}  // namespace pbnbrdf
