// fit_target.h: what a fit aims at, given a material.
#pragma once

#include <memory>

#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

// The material's best estimate and, where the encoding is reciprocal and the material isn't, of that
// the nearest reciprocal one: a loss that is next to absolute would take either of two values that
// contradict each other. material must outlive the target.
std::shared_ptr<const Brdf> FitTarget(const Brdf& material, Encoding encoding);

}  // namespace pbnbrdf
