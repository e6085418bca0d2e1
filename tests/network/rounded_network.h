// rounded_network.h: networks whose weights are numbers of half precision.
#pragma once

#include "base/half.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

inline NeuralBrdf RoundedOneByOne(const NeuralBrdf& network) {
  std::vector<double> weights = network.weights();
  for (double& weight : weights) weight = NearestHalf(weight);
  return NeuralBrdf(network.shape(), std::move(weights));
}

}  // namespace pbnbrdf
