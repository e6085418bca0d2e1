// c_source.h: a fitted network as a C99 header.
#pragma once

#include <string>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// A header that needs <math.h> only and is C++ as well:
//
//   void NAME_eval(const float wi[3], const float wo[3], float rgb[3]);
//
// wi points to the light, wo to the viewer: unit vectors, normal +z. rgb: linear, 1/sr, without the
// cosine; 0 where a direction isn't above the horizon. Computed in double precision: it is
// the value of NeuralBrdf at the same directions, rounded to float. Of a reciprocal encoding the
// value has the same bits if wi and wo are exchanged, with or without contraction to fused
// multiply-adds (but not with -ffast-math, where compilers promise nothing).
//
// name: an identifier of C. Throws Error otherwise.
std::string CSource(const NeuralBrdf& network, const std::string& name);

}  // namespace pbnbrdf
