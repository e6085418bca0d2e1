#include "pbnbrdf/render/demand.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "camera.h"
#include "path_tracer.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Tiles, and samples of each of their pixels, whose requests are in memory at a time: 64 x 4096 paths
// with a few requests of 80 bytes each, some 100 MB.
constexpr std::size_t kTilesPerPass = 64;
constexpr int kSamplesPerPass = 16;

// Of the same proportions, with at most max_pixels.
Film ShrunkFilm(const Film& film, int max_pixels) {
  const double pixels = double(film.width) * film.height;
  const double scale = std::min(1.0, std::sqrt(max_pixels / pixels));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(n * scale)); };
  return {side(film.width), side(film.height)};
}

// The requests for one material, added up.
struct RequestSum {
  double luminance = 0.0, sensitivity = 0.0;
  std::optional<AngleHistogram> histogram;  // once there is a request
};

class DemandMeter {
 public:
  DemandMeter(const Scene& scene, const RenderOptions& options, Materials* materials)
      : materials_(*materials),
        tracer_(scene, options, materials),
        tiles_(TilesOf(scene, tracer_.camera())),
        samples_(options.samples_per_pixel),
        statistics_(options.skip),
        pixels_(std::size_t(scene.film.width) * std::size_t(scene.film.height)),
        sums_(scene.materials.size()) {}

  // Requests are added in the same order with any number of threads, as sums depend on it.
  void Run() {
    std::vector<std::vector<Request>> requests(kTilesPerPass);
    for (int done = 0; done < samples_; done += kSamplesPerPass) {
      const int samples = std::min(kSamplesPerPass, samples_ - done);
      for (std::size_t begin = 0; begin < tiles_.size(); begin += kTilesPerPass) {
        const std::size_t count = std::min(kTilesPerPass, tiles_.size() - begin);
        ParallelFor(count,
                    [&](std::size_t i) { Trace(tiles_[begin + i], done, samples, &requests[i]); });
        materials_.ThrowIfFailed();
        for (std::size_t i = 0; i < count; ++i) Add(requests[i]);
      }
    }
  }

  // The demand for a material, by its number.
  MaterialDemand Demand(std::size_t i) const {
    const RequestSum& sum = sums_[i];
    MaterialDemand demand;
    demand.reached = materials_.IsReached(i);
    double image = 0.0;
    for (const PixelSum& pixel : pixels_) image += pixel.luminance;
    if (image > 0.0) {
      demand.share = sum.luminance / image;
      demand.sensitivity = sum.sensitivity / image;
    }
    if (sum.histogram && sum.histogram->Total() > 0.0) {
      demand.angles = std::make_shared<const AngleDistribution>(*sum.histogram);
    }
    return demand;
  }

 private:
  void Trace(const Tile& tile, int first, int count, std::vector<Request>* requests) {
    requests->clear();
    RequestLog log(requests);
    tracer_.Trace({std::span(&tile.block, 1), first, count, tile.empty}, pixels_, &statistics_,
                  &log);
  }

  void Add(const std::vector<Request>& requests) {
    for (const Request& request : requests) {
      const auto material = static_cast<std::size_t>(request.material);
      RequestSum& sum = sums_[material];
      if (!sum.histogram) sum.histogram.emplace(materials_.Reach(material)->brdf->IsIsotropic());
      sum.luminance += request.luminance;
      sum.sensitivity += request.sensitivity;
      sum.histogram->Add(request.pair, std::sqrt(request.luminance * request.sensitivity));
    }
  }

  Materials& materials_;
  const PathTracer tracer_;
  const std::vector<Tile> tiles_;
  const int samples_;
  Statistics statistics_;
  std::vector<PixelSum> pixels_;
  std::vector<RequestSum> sums_;
};

}  // namespace

std::vector<MaterialDemand> MeasureDemand(const Scene& scene, const MaterialOpener& open,
                                          const DemandOptions& options) {
  for (const auto& [name, value] :
       {std::pair("paths", options.paths), std::pair("max_pixels", options.max_pixels)}) {
    if (value < 1) Fail("DemandOptions::", name, " = ", value, "; must be >= 1");
  }
  Scene small = scene;
  small.film = ShrunkFilm(scene.film, options.max_pixels);
  const RenderOptions render = {
      .samples_per_pixel = std::max(1, options.paths / (small.film.width * small.film.height)),
      .seed = options.seed,
      .threads = options.threads,
      .max_bounces = options.max_bounces};
  ValidateRender(render);
  Materials materials(small, open);
  DemandMeter meter(small, render, &materials);
  WithThreads(options.threads, [&] { meter.Run(); });
  std::vector<MaterialDemand> demand;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) demand.push_back(meter.Demand(i));
  for (const Shape& shape : scene.shapes) demand[std::size_t(shape.material)].referenced = true;
  return demand;
}

}  // namespace pbnbrdf
