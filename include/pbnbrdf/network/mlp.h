// mlp.h: the network for one input, templated on the scalar: the reference that ceres::Jet runs
// through and that the batched kernels are tested against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// A hidden unit's value, on any T of brdf/operations.h. BatchedMlp has these from the kernels.
template <typename T>
T Activate(Activation activation, const T& x) {
  return activation == Activation::kTanh ? tanh(x) : Max(x, T(0.0));
}

// The last layer's values z, before the output unit. input: in(0) numbers; layers: a pointer to
// each layer's block (network_shape.h); z: kChannels numbers, equal if there is one output.
template <typename T>
void EvaluateMlp(const NetworkShape& shape, const double* input, T const* const* layers, T* z) {
  std::vector<T> from(input, input + shape.in(0)), to;
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    const T* row = layers[layer];
    to.assign(shape.out(layer), T(0.0));
    for (T& y : to) {
      y = row[from.size()];
      for (std::size_t i = 0; i < from.size(); ++i) y += row[i] * from[i];
      if (layer + 1 < shape.num_layers()) y = Activate(shape.activation(), y);
      row += from.size() + 1;
    }
    from.swap(to);
  }
  for (std::size_t c = 0; c < NetworkShape::kChannels; ++c)
    z[c] = from[std::min(c, from.size() - 1)];
}

// The output unit while fitting: f^ = expm1(z) > -1, smooth in z. What is evaluated is
// ClampedReflectance (expressions-inl.h), as with NBRDF; a clamp has no gradient, so none stands in the
// fit.
template <typename T>
T Reflectance(const T& z) {
  return expm1(z);
}

}  // namespace pbnbrdf
