// network/open_brdf.h: a source of reflectance from the text that names it, networks included.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// What OpenMeasuredBrdf (brdf/open_brdf.h) opens, or a network: "FILE.safetensors", or
// one that Sztrajman et al. published: "FILE.h5", "BASEfc1.npy" (nbrdf_files.h). Throws Error.
std::unique_ptr<Brdf> OpenBrdf(const std::string& source);

}  // namespace pbnbrdf
