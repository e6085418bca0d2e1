// fit_target.h: what a fit aims at, given a material.
#pragma once

#include <memory>

#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

// With a reciprocal encoding, the material's likeliest estimate and, where that isn't reciprocal, the nearest one that
// is: a loss that is next to absolute would take either of two values that contradict each other. Else the
// material as it is stored. material must outlive the target.
std::shared_ptr<const Brdf> FitTarget(const Brdf& material, Encoding encoding);

}  // namespace pbnbrdf
