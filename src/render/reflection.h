// reflection.h: what a material does to the paths that are on it: it reflects the light that is sampled there
// (next event estimation), and sends the paths on.
#pragma once

#include "pbnbrdf/brdf/importance_sampler.h"
#include "wavefront.h"

namespace pbnbrdf {

// Values of one material's BRDF, requested one by one and evaluated together, which is much faster for
// networks.
class BrdfBatch {
 public:
  // Begins a new batch; `stats` counts its values.
  void Begin(ThreadStatistics* stats) {
    stats_ = stats;
    pairs_.clear();
  }

  // Returns the number of the value.
  std::size_t Request(const DirectionPair& pair) {
    stats_->Needed(kKind);
    pairs_.push_back(pair);
    return pairs_.size() - 1;
  }

  // The image does not depend on this value: it is not evaluated, or evaluated and forgotten.
  void RequestUnneeded(SkipReason reason, const DirectionPair& pair) {
    if (stats_->Unneeded(kKind, reason)) pairs_.push_back(pair);
  }

  void Evaluate(const Brdf& brdf) {
    values_.resize(pairs_.size());
    if (pairs_.empty()) return;
    const ScopedTimer timer = stats_->Time(kKind);
    brdf.Evaluate(pairs_, values_);
  }

  const Rgb& value(std::size_t number) const { return values_[number]; }

 private:
  static constexpr auto kKind = &RenderWork::brdf_values;

  ThreadStatistics* stats_ = nullptr;
  std::vector<DirectionPair> pairs_;
  std::vector<Rgb> values_;
};

// Light sampled at the vertices of paths.
class DirectLight {
 public:
  // Samples a light at each vertex, and requests the BRDF where its light arrives. The vertices, of
  // one material, must outlive the call of Add.
  void Sample(std::span<const Vertex> vertices, Wavefront* wave, BrdfBatch* batch);

  // Adds the reflected light to the paths. sampler: of the material.
  void Add(const ImportanceSampler& sampler, const BrdfBatch& batch, Wavefront* wave);

 private:
  struct Arriving {
    const Vertex* vertex;
    DirectionPair pair;
    LightSample light;
    std::size_t request = 0;  // of the BRDF

    bool IsOccluded(const Geometry& geometry) const;
  };

  std::vector<Arriving> arriving_;
  std::vector<DirectionPair> swapped_;
  std::vector<double> pdfs_;
};

// The directions in which the paths go on.
class Scattering {
 public:
  // Draws a direction at each vertex, and requests the BRDF where its ray leads to a light or a
  // surface. The vertices, of one material, must outlive the call of Continue. sampler: of the
  // material.
  void Sample(std::span<const Vertex> vertices, const ImportanceSampler& sampler, Wavefront* wave,
              BrdfBatch* batch);

  // Takes the paths that survive Russian roulette to the ends of their rays.
  void Continue(const BrdfBatch& batch, Wavefront* wave);

 private:
  struct Scattered {
    const Vertex* vertex;
    DirectionPair pair;
    double pdf;
    Ray ray;
    RayEnd end = {};
    std::size_t request = 0;  // of the BRDF
  };

  void Draw(std::span<const Vertex> vertices, const ImportanceSampler& sampler, Wavefront* wave);

  std::vector<Scattered> scattered_;
  // Of Draw, one for each vertex.
  std::vector<Vec3> wo_, wi_;
  std::vector<std::array<double, 2>> numbers_;
  std::vector<double> pdfs_;
};

}  // namespace pbnbrdf
