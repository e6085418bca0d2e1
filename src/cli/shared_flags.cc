#include "shared_flags.h"

#include <gflags/gflags.h>

#include <cmath>

#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/sources/open_brdf.h"

DEFINE_string(material, "", "source of reflectance, see below; render: NAME=SOURCE, likewise");
DEFINE_double(
    scale_to_albedo, 0.0,
    "scale the material so that its largest directional albedo, up to 85 degrees, is this; "
    "0: as measured");
DEFINE_string(
    fit, "",
    "fitted network (.safetensors, or an NBRDF: .h5, fc1.npy); eval: or analytic model (.json)");
DEFINE_string(out, "", "file to write");
DEFINE_bool(json, false, "print one JSON object");

namespace pbnbrdf::cli {

std::vector<std::string> MaterialFlags() { return {"material", "scale_to_albedo"}; }

FlagGroup MaterialFlagsAnd(std::vector<std::string> names) {
  const std::vector<std::string> material = MaterialFlags();
  names.insert(names.begin(), material.begin(), material.end());
  return {"", names};
}

void CheckMaterialFlags() {
  RequireFlag("material", FLAGS_material);
  if (!(FLAGS_scale_to_albedo >= 0.0) || !std::isfinite(FLAGS_scale_to_albedo)) {
    throw UsageError(
        StrCat("--scale_to_albedo = ", FLAGS_scale_to_albedo, "; must be finite and >= 0"));
  }
}

std::unique_ptr<Brdf> OpenMaterial() {
  CheckMaterialFlags();
  std::unique_ptr<Brdf> material = OpenBrdf(FLAGS_material);
  if (FLAGS_scale_to_albedo == 0.0) return material;
  return AboutMaterial([&]() -> std::unique_ptr<Brdf> {
    return ScaleToAlbedo(std::move(material), FLAGS_scale_to_albedo);
  });
}

}  // namespace pbnbrdf::cli
