// mitsuba_plugin.h: a fitted network as a BSDF for Mitsuba 3 [1].
//
// [1] W. Jakob et al. Mitsuba 3 renderer. https://mitsuba-renderer.org
#pragma once

#include <string>

#include "pbnbrdf/brdf/importance_sampler.h"

namespace pbnbrdf {

// A Python file that registers the BSDF "pbnbrdf" when it is imported after mitsuba.set_variant(),
// for scalar, LLVM and CUDA variants in RGB or monochromatic mode. It needs nothing but Mitsuba. It
// draws directions as ImportanceSampler does. A scene names another network by the parameter
// "filename", and its proposal by "alpha_u", "alpha_v" and "lobe_weight"; without them it takes the
// file `network` from beside itself, and the proposal given here.
std::string MitsubaPlugin(const std::string& network, const LobeProposal& proposal);

}  // namespace pbnbrdf
