#include "material_options.h"

#include "base/about.h"
#include "pbnbrdf/brdf/reciprocal.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {

std::unique_ptr<Brdf> MaterialOptions::Open() const {
  std::unique_ptr<Brdf> material = OpenBrdf(source);
  if (symmetrize) material = std::make_unique<ReciprocalBrdf>(std::move(material));
  if (scale_to_albedo == 0.0) return material;
  return About(source, [&]() -> std::unique_ptr<Brdf> {
    return ScaleToAlbedo(std::move(material), scale_to_albedo);
  });
}

Field MaterialField(MaterialOptions* material) {
  return Text("material", &material->source, "source of reflectance, see below");
}

Field ScaleField(MaterialOptions* material) {
  return Number("scale_to_albedo", &material->scale_to_albedo, AtLeast(0.0),
                "scale the material so that its largest directional albedo, up to 85 degrees, is "
                "this; 0: as measured");
}

Field SymmetrizeField(bool* symmetrize) {
  return Switch(
      "symmetrize", symmetrize,
      "average f(wi, wo) and f(wo, wi), each by how well it is known: what a reciprocal fit "
      "aims at");
}

}  // namespace pbnbrdf::cli
