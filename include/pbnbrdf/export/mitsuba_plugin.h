// mitsuba_plugin.h: a fitted network as a BSDF for Mitsuba 3 [1].
//
// [1] W. Jakob et al. Mitsuba 3 renderer. https://mitsuba-renderer.org
#pragma once

#include <string>

#include "pbnbrdf/export/sampling_lobe.h"

namespace pbnbrdf {

// A Python file that registers the BSDF "pbnbrdf" when it is imported after mitsuba.set_variant(),
// for scalar, LLVM and CUDA variants in RGB or monochromatic mode. It needs nothing but Mitsuba. A
// scene names another network by the parameter "filename", and other lobes by "alpha" and "glossy";
// without them it takes the file `network` from beside itself, and the lobe given here.
std::string MitsubaPlugin(const std::string& network, const SamplingLobe& lobe);

}  // namespace pbnbrdf
