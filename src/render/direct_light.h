// direct_light.h: light sampled at the vertices of paths (next event estimation).
#pragma once

#include "brdf_batch.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "wavefront.h"

namespace pbnbrdf {

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

}  // namespace pbnbrdf
