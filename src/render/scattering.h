// scattering.h: the directions in which a material sends paths on.
#pragma once

#include "brdf_batch.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "wavefront.h"

namespace pbnbrdf {

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
