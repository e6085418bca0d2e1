#include "reflection.h"

#include <limits>

namespace pbnbrdf {
namespace {

// Reflections before Russian roulette begins, as in pbrt-v3.
constexpr int kMinBounces = 4;

// Ends the path with a probability of 1 minus its largest throughput.
bool SurvivesRoulette(int bounces, Path* path) {
  const double largest = Largest(path->throughput);
  if (!(largest > 0.0)) return false;
  if (bounces < kMinBounces || largest >= 1.0) return true;
  if (!(path->random.Next() < largest)) return false;
  for (double& channel : path->throughput) channel /= largest;
  return true;
}

}  // namespace

bool DirectLight::Arriving::IsOccluded(const Geometry& geometry) const {
  return geometry.Occluded(vertex->RayTo(light.direction), light.distance);
}

void DirectLight::Sample(std::span<const Vertex> vertices, Wavefront* wave, BrdfBatch* batch) {
  arriving_.clear();
  for (const Vertex& vertex : vertices) {
    LightSample light;
    Random& random = wave->paths[vertex.path].random;
    if (!wave->lights.Sample(vertex.position, &random, &light)) continue;
    const DirectionPair pair = {vertex.frame.ToLocal(light.direction), vertex.wo};
    const Arriving arriving = {&vertex, pair, light};
    const bool above = pair.wi.z > 0.0 && Dot(light.direction, vertex.normal) > 0.0;
    if (above && light.weight != Rgb{}) {
      arriving_.push_back(arriving);
      continue;
    }
    const SkipReason reason = above ? SkipReason::kUnlit : SkipReason::kBelowHorizon;
    batch->RequestUnneeded(reason, pair);
    if (wave->stats->Unneeded(&RenderWork::rays, reason)) {
      const ScopedTimer timer = wave->stats->Time(&RenderWork::rays);
      arriving.IsOccluded(wave->geometry);
    }
  }
  const ScopedTimer timer = wave->stats->Time(&RenderWork::rays);
  wave->stats->Needed(&RenderWork::rays, arriving_.size());
  std::erase_if(arriving_, [&](const Arriving& arriving) {
    if (!arriving.IsOccluded(wave->geometry)) return false;
    batch->RequestUnneeded(SkipReason::kOccluded, arriving.pair);
    return true;
  });
  for (Arriving& arriving : arriving_) arriving.request = batch->Request(arriving.pair);
}

void DirectLight::Add(const ImportanceSampler& sampler, const BrdfBatch& batch, Wavefront* wave) {
  const bool mis = wave->options.estimator == Estimator::kMis;
  swapped_.clear();
  for (const Arriving& arriving : arriving_) swapped_.push_back(Swapped(arriving.pair));
  pdfs_.resize(arriving_.size());
  if (mis) sampler.Pdf(swapped_, pdfs_);
  for (std::size_t i = 0; i < arriving_.size(); ++i) {
    const auto& [vertex, pair, light, request] = arriving_[i];
    const double weight = mis && light.pdf > 0.0 ? PowerHeuristic(light.pdf, pdfs_[i]) : 1.0;
    const Rgb& value = batch.value(request);
    Path& path = wave->paths[vertex->path];
    const Rgb arriving = weight * path.throughput * light.weight;
    path.radiance = path.radiance + pair.wi.z * value * arriving;
    if (wave->log) wave->log->AddLight(vertex->material, pair, value, arriving);
  }
}

void Scattering::Sample(std::span<const Vertex> vertices, const ImportanceSampler& sampler,
                        Wavefront* wave, BrdfBatch* batch) {
  Draw(vertices, sampler, wave);
  scattered_.clear();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vertex& vertex = vertices[i];
    const DirectionPair pair = {wi_[i], vertex.wo};
    const Vec3 world = vertex.frame.ToWorld(pair.wi);
    if (pdfs_[i] > 0.0 && Dot(world, vertex.normal) > 0.0) {
      scattered_.push_back({&vertex, pair, pdfs_[i], vertex.RayTo(Normalized(world))});
    } else {
      batch->RequestUnneeded(SkipReason::kBelowHorizon, pair);
    }
  }
  const ScopedTimer timer = wave->stats->Time(&RenderWork::rays);
  wave->stats->Needed(&RenderWork::rays, scattered_.size());
  std::erase_if(scattered_, [&](Scattered& scattered) {
    scattered.end = wave->Follow(scattered.ray, wave->bounces + 1, scattered.pdf);
    if (scattered.end.kind != RayEnd::Kind::kNothing) return false;
    batch->RequestUnneeded(SkipReason::kUnlit, scattered.pair);
    return true;
  });
  for (Scattered& scattered : scattered_) scattered.request = batch->Request(scattered.pair);
}

void Scattering::Draw(std::span<const Vertex> vertices, const ImportanceSampler& sampler,
                      Wavefront* wave) {
  wo_.clear();
  numbers_.clear();
  for (const Vertex& vertex : vertices) {
    wo_.push_back(vertex.wo);
    numbers_.push_back(wave->paths[vertex.path].random.Pair());
  }
  wi_.resize(vertices.size());
  pdfs_.resize(vertices.size());
  sampler.Sample(wo_, numbers_, wi_, pdfs_);
}

void Scattering::Continue(const BrdfBatch& batch, Wavefront* wave) {
  for (const auto& [vertex, pair, pdf, ray, end, request] : scattered_) {
    const Rgb& value = batch.value(request);
    Path& path = wave->paths[vertex->path];
    for (std::size_t c = 0; c < 3; ++c) path.throughput[c] *= pair.wi.z * value[c] / pdf;
    if (!IsFinite(path.throughput)) {
      path.radiance.fill(std::numeric_limits<double>::quiet_NaN());  // the sample is dropped
    } else if (SurvivesRoulette(wave->bounces, &path)) {
      if (wave->log) {
        wave->log->Continue(vertex->path, vertex->material, pair, value, path.radiance);
      }
      wave->Arrive(vertex->path, ray, end);
    }
  }
}

}  // namespace pbnbrdf
