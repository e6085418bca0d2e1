#include "material_options.h"

#include "base/about.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf::cli {

std::unique_ptr<Brdf> MaterialOptions::Open() const {
  std::unique_ptr<Brdf> material = OpenBrdf(source);
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

}  // namespace pbnbrdf::cli
