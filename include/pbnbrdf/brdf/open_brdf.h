// open_brdf.h: a source of reflectance from the text that names it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// "FILE.binary" (MERL), "sgd:PARAMETERS.csv#MATERIAL", "builtin:NAME", an analytic model with its
// parameters, "MODEL:NAME=VALUE,..." (analytic.h), or the file of one, "FILE.json". Throws Error.
std::unique_ptr<Brdf> OpenMeasuredBrdf(const std::string& source);

}  // namespace pbnbrdf
