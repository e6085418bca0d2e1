// random_network.h: weights for tests.
#pragma once

#include <vector>

#include "pbnbrdf/network/network_shape.h"
#include "test_util.h"

namespace pbnbrdf {

// Uniform in +-scale.
inline std::vector<double> RandomWeights(const NetworkShape& shape, double scale, unsigned seed) {
  return RandomNumbers(shape.num_weights(), -scale, scale, seed);
}

}  // namespace pbnbrdf
