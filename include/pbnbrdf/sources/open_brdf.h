// open_brdf.h: a source of reflectance from the text that names it.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// "sgd:PARAMETERS.csv#MATERIAL" (models/sgd.h), "builtin:NAME" (models/builtin.h), an analytic model with
// its parameters, "MODEL:NAME=VALUE,..." (models/analytic.h), or a file: FILE.json (of an analytic model),
// FILE.bsdf (rgl.h), FILE.alta or FILE.dat (ALTA) or FILE.csv (scattered_files.h), FILE.binary (merl.h), or
// what OpenNetwork opens. Files of other names are told by what they begin with, and are MERL tables if
// nothing else. Throws Error.
std::unique_ptr<Brdf> OpenBrdf(const std::string& source);

// A fitted network, "FILE.safetensors", or one that Sztrajman et al. published: "FILE.h5", "BASEfc1.npy"
// (nbrdf_files.h). Throws Error.
NeuralBrdf OpenNetwork(const std::string& path);

}  // namespace pbnbrdf
