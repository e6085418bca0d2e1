// studio.h: images of a scene with one material after another in the place of its own, to be compared.
#pragma once

#include <functional>
#include <memory>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/render/render.h"

namespace pbnbrdf {

// All images follow the same paths, which suit the first material, so that they differ by the
// materials alone.
class Studio {
 public:
  // scene: of one material; must outlive this.
  Studio(const Scene& scene, const Brdf& material, int samples_per_pixel, int threads);

  Image Photograph(const std::function<std::unique_ptr<Brdf>()>& make) const;

 private:
  const Scene& scene_;
  Proposal proposal_;
  RenderOptions options_;
};

}  // namespace pbnbrdf
