// lpips_weights.h: random weights of LPIPS' network, for tests.
#pragma once

#include "pbnbrdf/metrics/lpips.h"
#include "test_util.h"

namespace pbnbrdf {

// Such that the features of every layer are of the order of 1; heads in [0, 1).
inline LpipsWeights RandomLpipsWeights(unsigned seed) {
  LpipsWeights weights;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const LpipsLayerShape& shape = kLpipsLayers[k];
    const std::size_t units = std::size_t(shape.units);
    const int patch = shape.inputs * shape.kernel * shape.kernel;
    const double bound = std::sqrt(6.0 / patch);
    const unsigned layer_seed = seed + 10 * static_cast<unsigned>(k);
    weights[k].kernels =
        RandomNumbers(units * static_cast<std::size_t>(patch), -bound, bound, layer_seed);
    weights[k].biases = RandomNumbers(units, -0.2, 0.2, layer_seed + 1);
    weights[k].head = RandomNumbers(units, 0.0, 1.0, layer_seed + 2);
  }
  return weights;
}

}  // namespace pbnbrdf
