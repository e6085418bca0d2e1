#include "pbnbrdf/render/demand.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "arena.h"
#include "materials.h"
#include "path_tracer.h"
#include "pbnbrdf/base/error.h"
#include "tiles.h"

namespace pbnbrdf {
namespace {

// Tiles, and samples of their pixels, whose requests are kept at a time.
constexpr std::size_t kTilesAtOnce = 64;
constexpr int kSamplesAtOnce = 16;

Film SmallFilm(const Film& film, int most_pixels) {
  const double pixels = double(film.width) * film.height;
  const double scale = std::min(1.0, std::sqrt(most_pixels / pixels));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(n * scale)); };
  return {side(film.width), side(film.height)};
}

// What the requests for a material add up to.
struct Sum {
  double luminance = 0.0, sensitivity = 0.0;
  std::optional<AngleHistogram> histogram;  // from the first request on
};

class DemandMeter {
 public:
  DemandMeter(const Scene& scene, const RenderOptions& options, Materials* materials)
      : materials_(*materials),
        camera_(scene.camera, scene.film),
        geometry_(scene),
        tracer_(scene, camera_, geometry_, options, materials),
        tiles_(TilesOf(scene, camera_)),
        samples_(options.samples_per_pixel),
        pixels_(std::size_t(scene.film.width) * std::size_t(scene.film.height)),
        sums_(scene.materials.size()) {}

  // The order in which requests are added doesn't depend on the threads.
  void Run(tbb::task_arena* arena) {
    std::vector<std::vector<Request>> requests(kTilesAtOnce);
    for (int done = 0; done < samples_; done += kSamplesAtOnce) {
      const int samples = std::min(kSamplesAtOnce, samples_ - done);
      for (std::size_t begin = 0; begin < tiles_.size(); begin += kTilesAtOnce) {
        const std::size_t count = std::min(kTilesAtOnce, tiles_.size() - begin);
        arena->execute([&] {
          tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            Trace(tiles_[begin + i], done, samples, &requests[i]);
          });
        });
        materials_.ThrowIfFailed();
        for (std::size_t i = 0; i < count; ++i) Add(requests[i]);
      }
    }
  }

  // Of each material, those that no path reached excepted.
  void Finish(std::vector<MaterialDemand>* demand) const {
    double image = 0.0;
    for (const PixelSum& pixel : pixels_) image += pixel.luminance;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      MaterialDemand& material = (*demand)[i];
      material.reached = materials_.IsReached(i);
      if (image > 0.0) {
        material.share = sums_[i].luminance / image;
        material.sensitivity = sums_[i].sensitivity / image;
      }
      if (!sums_[i].histogram || !(sums_[i].histogram->Total() > 0.0)) continue;
      material.angles = std::make_shared<const AngleDistribution>(*sums_[i].histogram);
    }
  }

 private:
  void Trace(const Tile& tile, int first, int count, std::vector<Request>* requests) {
    requests->clear();
    RequestLog log(requests);
    TileCounts counts;
    tracer_.Trace({std::span(&tile.block, 1), first, count, tile.empty}, pixels_, &counts, &log);
  }

  void Add(const std::vector<Request>& requests) {
    for (const Request& request : requests) {
      const auto material = static_cast<std::size_t>(request.material);
      Sum& sum = sums_[material];
      if (!sum.histogram) sum.histogram.emplace(materials_.Reach(material)->brdf->IsIsotropic());
      sum.luminance += request.luminance;
      sum.sensitivity += request.sensitivity;
      sum.histogram->Add(request.pair, std::sqrt(request.luminance * request.sensitivity));
    }
  }

  Materials& materials_;
  const PinholeCamera camera_;
  const Geometry geometry_;
  const PathTracer tracer_;
  const std::vector<Tile> tiles_;
  const int samples_;
  std::vector<PixelSum> pixels_;
  std::vector<Sum> sums_;
};

}  // namespace

std::vector<MaterialDemand> MeasureDemand(const Scene& scene, const MaterialOpener& open,
                                          const DemandOptions& options) {
  for (const auto& [name, value] :
       {std::pair("paths", options.paths), std::pair("most_pixels", options.most_pixels)}) {
    if (value < 1) Fail("DemandOptions::", name, " = ", value, "; must be >= 1");
  }
  Scene small = scene;
  small.film = SmallFilm(scene.film, options.most_pixels);
  const RenderOptions render = {
      .samples_per_pixel = std::max(1, options.paths / (small.film.width * small.film.height)),
      .seed = options.seed,
      .threads = options.threads,
      .max_bounces = options.max_bounces};
  ValidateRender(render);
  Materials materials(small, open);
  tbb::task_arena arena(ArenaThreads(options.threads));
  DemandMeter meter(small, render, &materials);
  meter.Run(&arena);
  std::vector<MaterialDemand> demand(scene.materials.size());
  for (const Shape& shape : scene.shapes) demand[std::size_t(shape.material)].referenced = true;
  meter.Finish(&demand);
  return demand;
}

}  // namespace pbnbrdf
