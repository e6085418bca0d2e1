// passes.h: the parts of a network's forward and backward passes: products with the weights of a
// layer, and activations. Layouts and T: kernels.h.
#pragma once

#include <cstddef>

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// y = W x + b. By feature: x in x kBatch, y out x kBatch. layer: [W | b], row-major, out x (in +
// 1).
template <typename T>
void Dense(const T* layer, int out, int in, const T* x, T* y);

// y = tanh(W x + b). Absolute error of tanh below 4e-7 (float; 2e-7 with AVX-512) or 1e-14 (double); odd,
// within [-1, 1], NaN for NaN.
template <typename T>
void DenseTanh(const T* layer, int out, int in, const T* x, T* y);

// y = max(0, W x + b), NaN for NaN.
template <typename T>
void DenseRelu(const T* layer, int out, int in, const T* x, T* y);

// The derivative of DenseRelu: sets delta to 0 where y <= 0. count: a multiple of kBatch.
template <typename T>
void ReluSlopes(const T* y, std::size_t count, T* delta);

// x = W' y, the bias left out. Shapes as for Dense.
template <typename T>
void DenseTransposed(const T* layer, int out, int in, const T* y, T* x);

// In place, to a few units in the last place. count: a multiple of kBatch.
template <typename T>
void Exp(T* x, std::size_t count);

}  // namespace pbnbrdf::kernels
