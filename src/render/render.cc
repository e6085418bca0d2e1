#include "pbnbrdf/render/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "arena.h"
#include "base/timer.h"
#include "materials.h"
#include "path_tracer.h"
#include "pbnbrdf/base/error.h"
#include "pixels.h"
#include "tiles.h"

namespace pbnbrdf {
namespace {

constexpr int kMostSamples = 1 << 24;
constexpr int kMostBounces = 100000;

// So many samples of each of a tile's pixels at a time: thousands of paths keep networks busy.
constexpr int kSamplesAtOnce = 16;

// A tile and how far it is.
struct TileState {
  Tile tile;
  std::vector<PixelBlock> blocks;  // whose pixels get more samples
  TileCounts counts = {};
};

// Renders tile by tile until all samples are there or the caller has had enough.
class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Materials* materials)
      : scene_(scene),
        options_(options),
        materials_(*materials),
        camera_(scene.camera, scene.film),
        geometry_(scene),
        tracer_(scene, camera_, geometry_, options, materials),
        pixels_(std::size_t(scene.film.width) * std::size_t(scene.film.height)) {
    for (const Tile& tile : TilesOf(scene, camera_)) {
      const bool judged = options.target_error > 0.0;
      tiles_.push_back({tile, Cut(tile.block, judged ? kJudgedTogether : kTileSize)});
    }
  }

  void Run(tbb::task_arena* arena) {
    // One sample of every pixel first: an early stop leaves a picture, too.
    for (int done = 0, count = 1; done < options_.samples_per_pixel && !Finished(); done += count) {
      if (done > 0) count = std::min(kSamplesAtOnce, options_.samples_per_pixel - done);
      arena->execute([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, tiles_.size(), 1),
            [&](const tbb::blocked_range<std::size_t>& range) {
              for (std::size_t i = range.begin(); i != range.end(); ++i) {
                TraceTile(done, count, &tiles_[i]);
              }
            },
            tbb::simple_partitioner());
      });
      materials_.ThrowIfFailed();
    }
  }

  Rendering Result() const {
    Rendering result;
    result.image = Image(scene_.film.width, scene_.film.height);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const PixelSum& pixel = pixels_[i];
      result.samples.push_back(pixel.samples);
      result.summary.samples += pixel.samples;
      if (pixel.samples == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        // The mean of finite values may yet be too large for a float.
        const double mean = pixel.radiance[c] / static_cast<double>(pixel.samples);
        result.image.rgb[3 * i + c] =
            static_cast<float>(std::min(mean, double(std::numeric_limits<float>::max())));
      }
    }
    for (const TileState& state : tiles_) {
      result.summary.dropped_samples += state.counts.dropped_samples;
      result.summary.work += state.counts.work;
    }
    result.summary.work.materials = materials_.Count();
    result.summary.stopped = stopped_;
    return result;
  }

 private:
  bool Finished() const {
    return stopped_ || std::all_of(tiles_.begin(), tiles_.end(),
                                   [](const TileState& state) { return state.blocks.empty(); });
  }

  void TraceTile(int first, int count, TileState* state) {
    if (stopped_ || state->blocks.empty()) return;
    TileCounts& counts = state->counts;
    const std::int64_t samples_before = counts.work.samples.done;
    tracer_.Trace({state->blocks, first, count, state->tile.empty}, pixels_, &counts);
    std::int64_t samples = counts.work.samples.done - samples_before;
    if (options_.target_error > 0.0) {
      const std::int64_t saved =
          RemoveConverged(pixels_, scene_.film.width, options_.target_error, &state->blocks) *
          (options_.samples_per_pixel - first - count);
      counts.work.samples.Skipped(SkipReason::kConverged) += saved;
      samples += saved;
    }
    ReportProgress(samples);
  }

  // samples: done, or no longer needed, since the last report of the thread.
  void ReportProgress(std::int64_t samples) {
    if (!options_.on_progress) return;
    const std::lock_guard lock(progress_mutex_);
    samples_done_ += samples;
    const double all = double(pixels_.size()) * options_.samples_per_pixel;
    if (!options_.on_progress({double(samples_done_) / all, timer_.Seconds()})) {
      stopped_ = true;
    }
  }

  const Scene& scene_;
  const RenderOptions& options_;
  Materials& materials_;
  const PinholeCamera camera_;
  const Geometry geometry_;
  const PathTracer tracer_;
  std::vector<TileState> tiles_;
  std::vector<PixelSum> pixels_;
  std::atomic<bool> stopped_ = false;
  std::mutex progress_mutex_;
  std::int64_t samples_done_ = 0;
  const Timer timer_;
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
  if (!(options.target_error >= 0.0) || !std::isfinite(options.target_error)) {
    Fail("RenderOptions::target_error = ", options.target_error, "; must be finite and >= 0");
  }
}

Rendering Render(const Scene& scene, const MaterialOpener& open, const RenderOptions& options) {
  ValidateRender(options);
  const Timer timer;
  tbb::task_arena arena(ArenaThreads(options.threads));
  Materials materials(scene, open);
  if (!options.skip) arena.execute([&] { materials.OpenAll(); });
  Renderer renderer(scene, options, &materials);
  renderer.Run(&arena);
  Rendering rendering = renderer.Result();
  rendering.summary.seconds = timer.Seconds();
  return rendering;
}

}  // namespace pbnbrdf
