// lpips_weights.h: the file of weights that compare --lpips takes.
#pragma once

#include <string>

#include "pbnbrdf/metrics/lpips.h"

namespace pbnbrdf::cli {

// Reads a safetensors file of F32 or F64 tensors named as in the state of the Python package lpips
// (its LPIPS(net='alex')): net.slice1.0.weight, net.slice1.0.bias, ..., lin4.model.1.weight; others
// are ignored. Throws Error as ReadSafetensors does, and if one is missing or of another shape.
LpipsWeights ReadLpipsWeights(const std::string& path);

}  // namespace pbnbrdf::cli
