#include "direct_light.h"

namespace pbnbrdf {

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

}  // namespace pbnbrdf
