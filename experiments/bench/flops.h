// flops.h: how many multiplications and additions of numbers a network's passes take.
#pragma once

#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// Of J'J for one sample (normal_equations.h), pair products left out.
inline double HessianFlops(const NetworkShape& shape) {
  double flops = 0.0;
  for (int l = 0; l < shape.num_layers(); ++l) {
    const double out = shape.out(l), in = shape.in(l) + 1;
    flops += 2.0 * (out * (out + 1) / 2) * (in * (in + 1) / 2);
    for (int m = l + 1; m < shape.num_layers(); ++m) {
      flops += 2.0 * out * shape.out(m) * in * (shape.in(m) + 1);
    }
  }
  return flops;
}

// Of the passes of one sample: forward, and back to the first layer for each of `rows` residuals.
inline double PassFlops(const NetworkShape& shape, int rows) {
  double flops = 2.0 * shape.num_weights();
  for (int l = 1; l < shape.num_layers(); ++l) flops += 2.0 * rows * shape.out(l) * shape.in(l);
  return flops;
}

}  // namespace pbnbrdf
