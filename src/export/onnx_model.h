// onnx_model.h: a fitted network as an ONNX model [1].
//
// [1] Open Neural Network Exchange. https://onnx.ai, onnx/onnx.proto.
#pragma once

#include <string>

#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// The bytes of a model of operator set 17, IR version 8: inputs "wi" and "wo" (N x 3, float32),
// output "rgb" (N x 3, float32), directions and value as in c_source.h. It includes encoding,
// horizon and output unit. About 1e-5 f + 1e-6 apart from NeuralBrdf, with the merl encoding
// up to 1e-4 (1 + f). Of a reciprocal encoding the value has the same bits if wi and wo
// are exchanged, as all inputs of the first layer have.
//
// Throws Error if a weight is beyond float32.
std::string OnnxModel(const NeuralBrdf& network);

}  // namespace pbnbrdf
