// glsl_source.h: a fitted network as a function of OpenGL's shading language.
#pragma once

#include <string>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// Functions for a shader of GLSL ES 3.00 (WebGL 2) or later, to be put after its #version line:
//
//   vec3 NAME_eval(vec3 wi, vec3 wo);
//
// Directions and value as in c_source.h, in single precision (highp): about 1e-5 f + 1e-6 apart
// from NeuralBrdf, with the merl encoding up to 1e-4 (1 + f). It uses no built-in
// function but sqrt, abs, floor, min and max: the language allows an arc tangent to be off by 4096
// units in the last place. Of a reciprocal encoding the value has the same bits if wi and wo are
// exchanged.
//
// It makes highp the default precision, also for what follows it in the shader.
//
// name: an identifier of GLSL that doesn't begin with "gl_" nor has "__" in it. Throws Error
// otherwise, or if a weight is beyond single precision.
std::string GlslSource(const NeuralBrdf& network, const std::string& name);

}  // namespace pbnbrdf
