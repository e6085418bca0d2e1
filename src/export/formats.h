// formats.h: what ExportedFiles (export.h) writes. Each function is in the file of its name.
//
// [1] W. Jakob et al. Mitsuba 3 renderer. https://mitsuba-renderer.org
// [2] Open Neural Network Exchange. https://onnx.ai, onnx/onnx.proto.
// [3] PyTorch. https://pytorch.org
#pragma once

#include <string>

#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// A C99 header that needs <math.h> only and is C++ as well:
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

// How a shader's weights are stored: in single precision, rounded to it, or two of half precision to an integer, which
// they must be already (solve/half_weights.h). It computes in single precision.
enum class WeightStorage { kSingle, kHalf };

// Functions for a shader, of which others may call
//
//   vec3 NAME_eval(vec3 wi, vec3 wo);                              GLSL ES 3.00 (WebGL 2) or later
//   float3 NAME_eval(float3 wi, float3 wo);                        HLSL of shader model 5 or later, Slang
//   fn NAME_eval(wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32>        WGSL
//
// Directions and value as of CSource, in single precision: about 1e-5 f + 1e-6 apart from NeuralBrdf, three times as
// much where both directions are near the horizon, with the merl encoding up to 1e-4 (1 + f). They use no built-in function but sqrt, abs, sign, floor, min and max: the languages allow
// an arc tangent to be off by 4096 units in the last place. Of a reciprocal encoding the value has the same bits if wi
// and wo are exchanged.
//
// GLSL is to be put after its #version line, and makes highp the default precision, also for what follows it.
//
// name: an identifier of the language; of GLSL it doesn't begin with "gl_" nor has "__" in it, of WGSL NAME_eval
// doesn't begin with "__". Throws Error otherwise, or if a weight isn't a number of the kind that is stored.
std::string GlslSource(const NeuralBrdf& network, const std::string& name,
                       WeightStorage storage = WeightStorage::kSingle);
std::string HlslSource(const NeuralBrdf& network, const std::string& name,
                       WeightStorage storage = WeightStorage::kSingle);
std::string WgslSource(const NeuralBrdf& network, const std::string& name,
                       WeightStorage storage = WeightStorage::kSingle);

// A Python file that registers the BSDF "pbnbrdf" in Mitsuba 3 [1] when it is imported after mitsuba.set_variant(),
// for scalar, LLVM and CUDA variants in RGB, spectral or monochromatic mode. It needs nothing but Mitsuba. It draws
// directions as ImportanceSampler does. It takes the files `network` and `proposal` (MitsubaProposal) from beside itself,
// unless a scene names others.
std::string MitsubaPlugin(const std::string& network, const std::string& proposal);

// The bytes of a safetensors file: "cells" (azimuths x cosines x rings x sectors), "cosine_share" (azimuths x
// cosines), "spread" (1).
std::string MitsubaProposal(const Proposal& proposal);

// The bytes of an ONNX model [2] of operator set 17, IR version 8: inputs "wi" and "wo" (N x 3, float32),
// output "rgb" (N x 3, float32), directions and value as of CSource. It includes encoding,
// horizon and output unit. About 1e-5 f + 1e-6 apart from NeuralBrdf, with the merl encoding
// up to 1e-4 (1 + f). Of a reciprocal encoding the value has the same bits if wi and wo
// are exchanged, as all inputs of the first layer have.
//
// Throws Error if a weight is beyond float32.
std::string OnnxModel(const NeuralBrdf& network);

// A Python file with a class NAME, a torch.nn.Module [3] with the network's weights as parameters: called with wi and wo
// (... x 3), it gives rgb (... x 3) as of CSource, in the precision of its parameters, double at first, and with
// gradients. It needs nothing but torch. name: an identifier. Throws Error otherwise.
std::string TorchModule(const NeuralBrdf& network, const std::string& name);

// The bytes of a file as those of the RGL database (sources/rgl.h, [1] there), of their sizes: 8 theta_i, uniform in
// cos theta_i, the last one 90 degrees; one phi_i, or 17 of an anisotropic source; 128 x 128 normals, 32 x 32 colours.
// What it holds at the nodes is the source, in between it is what such tables interpolate.
std::string RglFile(const Brdf& source);

// The same with spectra of 16 wavelengths, from 400 to 700 nm, that are seen as the source's colours (sources/cie.h).
std::string SpectralRglFile(const Brdf& source);

// A glTF 2.0 file of one material, with the KHR extensions that it needs, and a MaterialX document of one, a gltf_pbr
// shader. Of a principled model (models/principled.h); its errors against the material it was fitted to are said in
// extras.approximation or in comments. name: of the material; in MaterialX an identifier. Throws Error otherwise.
std::string GltfMaterial(const AnalyticBrdf& principled, const std::string& name);
std::string MaterialX(const AnalyticBrdf& principled, const std::string& name);

// A CSV with the columns theta_i,phi_i,theta_o,phi_o (radians) and r,g,b (linear, 1/sr, without the
// cosine), one header line. The grid is one of Rusinkiewicz angles:
//
//   theta_h = (pi/2) (i/45)^2, i = 0..44     dense near the mirror direction
//   theta_d = i 5 degrees, i = 0..17
//   phi_d   = i 15 degrees, i = 0..23
//   phi_h   = 0 if the Brdf is isotropic, else i 30 degrees, i = 0..11
//
// of which the pairs above the horizon are written, each once. Values are those at the angles as
// they are written. Isotropic: phi_i = 0.
std::string CsvTable(const Brdf& brdf);

}  // namespace pbnbrdf
