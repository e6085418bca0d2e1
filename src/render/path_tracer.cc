#include "path_tracer.h"

#include <algorithm>

namespace pbnbrdf {
namespace {

// Counts one vertex of each path that goes on.
void CountVertices(std::size_t count, Wavefront* wave) {
  wave->stats->Needed(&RenderWork::path_vertices, count);
  wave->stats->LeftOut(&RenderWork::path_vertices, SkipReason::kEnded, wave->paths.size() - count);
}

}  // namespace

PathTracer::PathTracer(const Scene& scene, const RenderOptions& options, Materials* materials)
    : options_(options),
      materials_(*materials),
      film_(scene.film),
      camera_(scene.camera, scene.film),
      geometry_(scene),
      lights_(scene, options.estimator),
      workers_([this] {
        return Worker{{geometry_, lights_, options_}};
      }) {}

std::int64_t PathTracer::Trace(const SampleRange& range, std::span<PixelSum> pixels,
                               Statistics* statistics, RequestLog* log) const {
  Worker& worker = workers_.Local();
  Wavefront& wave = worker.wave;
  wave.stats = &statistics->OfThisThread();
  wave.log = log;
  const ScopedTimer timer = wave.stats->Time(&RenderWork::samples);
  StartPaths(range, &wave);
  ShadeVertices(&worker);
  wave.stats->Needed(&RenderWork::samples, wave.paths.size());
  if (log) log->EndPaths(wave.paths);
  for (const Path& path : wave.paths) {
    if (IsFinite(path.radiance)) pixels[path.pixel].Add(path.radiance);
  }
  return static_cast<std::int64_t>(wave.paths.size());
}

void PathTracer::StartPaths(const SampleRange& range, Wavefront* wave) const {
  const ScopedTimer timer = wave->stats->Time(&RenderWork::rays);
  wave->paths.clear();
  for (const PixelBlock& block : range.blocks) {
    for (int y = block.y; y < block.y + block.height; ++y) {
      for (int x = block.x; x < block.x + block.width; ++x) {
        for (int i = 0; i < range.count; ++i) {
          StartPath(x, y, range.first + i, range.empty, wave);
        }
      }
    }
  }
  CountVertices(wave->paths.size(), wave);
}

void PathTracer::StartPath(int x, int y, int sample, bool empty, Wavefront* wave) const {
  Path path;
  path.pixel = std::size_t(y) * std::size_t(film_.width) + std::size_t(x);
  path.random = Random(options_.seed, path.pixel, std::uint64_t(sample));
  const auto [dx, dy] = path.random.Pair();
  const Ray ray = camera_.RayThrough(x + dx, y + dy);
  const bool trace = empty ? wave->stats->Unneeded(&RenderWork::rays, SkipReason::kEmptyTiles)
                           : wave->stats->Needed(&RenderWork::rays);
  wave->paths.push_back(path);
  wave->Arrive(wave->paths.size() - 1, ray, wave->Follow(ray, 0, 0.0, trace));
}

// Reflects the paths, all those on one material together, until none goes on.
void PathTracer::ShadeVertices(Worker* worker) const {
  auto& [wave, batch, direct_light, scattering] = *worker;
  const auto by_material = [](const Vertex& a, const Vertex& b) { return a.material < b.material; };
  for (wave.bounces = 0; !wave.reached.empty(); ++wave.bounces) {
    wave.vertices.swap(wave.reached);
    wave.reached.clear();
    CountVertices(wave.vertices.size(), &wave);
    std::stable_sort(wave.vertices.begin(), wave.vertices.end(), by_material);
    for (auto begin = wave.vertices.begin(), end = begin; begin != wave.vertices.end();
         begin = end) {
      end = std::upper_bound(begin, wave.vertices.end(), *begin, by_material);
      const PreparedMaterial* material = OpenMaterial(begin->material, wave.stats);
      if (material == nullptr) continue;
      batch.Begin(wave.stats);
      direct_light.Sample({begin, end}, &wave, &batch);
      scattering.Sample({begin, end}, *material->sampler, &wave, &batch);
      batch.Evaluate(*material->brdf);
      direct_light.Add(*material->sampler, batch, &wave);
      scattering.Continue(batch, &wave);
    }
  }
}

// Opening counts as work on the material, not as work on samples.
const PreparedMaterial* PathTracer::OpenMaterial(int material, ThreadStatistics* stats) const {
  const Timer timer;
  const PreparedMaterial* opened = materials_.Reach(std::size_t(material));
  stats->SubtractSeconds(&RenderWork::samples, timer.Seconds());
  return opened;
}

}  // namespace pbnbrdf
