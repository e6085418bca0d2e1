// adam_step.h: the inner loop of the Adam optimizer. T: kernels.h.
#pragma once

#include <cstddef>

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// A step of Adam. The caller corrects the bias of mean and square, through rate and epsilon:
//   mean = beta1 mean + (1 - beta1) g,  square = beta2 square + (1 - beta2) g^2,
//   x -= rate mean / (sqrt(square) + epsilon).
// A mean or square below 1e-35 becomes 0. count: a multiple of kPad.
template <typename T>
void AdamStep(std::size_t count, const T* gradient, T rate, T beta1, T beta2, T epsilon, T* mean,
              T* square, T* x);

}  // namespace pbnbrdf::kernels
