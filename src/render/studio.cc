#include "render/studio.h"

namespace pbnbrdf {

Studio::Studio(const Scene& scene, const Brdf& material, int samples_per_pixel, int threads)
    : scene_(scene), proposal_(FitProposal(material)) {
  options_.samples_per_pixel = samples_per_pixel;
  options_.threads = threads;
}

Image Studio::Photograph(const std::function<std::unique_ptr<Brdf>()>& make) const {
  const auto open = [&](const std::string&) { return OpenedMaterial{make(), proposal_}; };
  return Render(scene_, open, options_).image;
}

}  // namespace pbnbrdf
