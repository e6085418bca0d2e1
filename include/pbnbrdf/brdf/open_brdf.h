// open_brdf.h: a source of reflectance from the text that names it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// "sgd:PARAMETERS.csv#MATERIAL", "builtin:NAME", an analytic model with its parameters,
// "MODEL:NAME=VALUE,..." (analytic.h), or a file: FILE.json (of an analytic model), FILE.bsdf (rgl.h),
// FILE.alta or FILE.dat (ALTA) or FILE.csv (scattered_files.h), FILE.binary (merl.h). Files of other
// names are told by what they begin with, and are MERL tables if nothing else. Throws Error.
std::unique_ptr<Brdf> OpenMeasuredBrdf(const std::string& source);

}  // namespace pbnbrdf
