// fred.h: measured BSDF in the text of FRED (Photon Engineering).
//
//   type bsdf_data
//   format angles=deg bsdf=value scale=1
//
// and for each incident direction a line with its theta and phi and then rows of theta_s phi_s f, in degrees and
// 1/sr, without the cosine. phi_s is counted from the specular side: phi_o = phi_i + 180 + phi_s.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Throws Error, naming the file and the line.
ScatteredBrdf ReadFred(const std::string& path);

// Whether a text's first line is "type bsdf_data".
bool LooksLikeFred(std::string_view start);

}  // namespace pbnbrdf
