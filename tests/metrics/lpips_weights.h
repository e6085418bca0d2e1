// lpips_weights.h: random weights of LPIPS' network, for tests.
#pragma once

#include "base/text.h"
#include "network/safetensors.h"
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

// Their file as the Python package lpips names its tensors, with some that aren't needed.
inline SafetensorsFile LpipsFile(const LpipsWeights& weights) {
  const char* names[] = {"net.slice1.0", "net.slice2.3", "net.slice3.6", "net.slice4.8",
                         "net.slice5.10"};
  SafetensorsFile file;
  file.tensors["scaling_layer.shift"] = {{1, 3, 1, 1}, {-0.03, -0.088, -0.188}};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const LpipsLayerShape& shape = kLpipsLayers[k];
    const std::string name = names[k];
    file.tensors[name + ".weight"] = {{shape.units, shape.inputs, shape.kernel, shape.kernel},
                                      weights[k].kernels};
    file.tensors[name + ".bias"] = {{shape.units}, weights[k].biases};
    file.tensors[StrCat("lin", k, ".model.1.weight")] = {{1, shape.units, 1, 1}, weights[k].head};
    file.tensors[StrCat("lins.", k, ".model.1.weight")] = {{1}, {0.0}};
  }
  return file;
}

}  // namespace pbnbrdf
