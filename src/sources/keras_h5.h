// keras_h5.h: the weights of dense layers in an HDF5 file that Keras wrote: the datasets
// /dense_1/dense_1/kernel:0 (in x out), /dense_1/dense_1/bias:0 (out), /dense_2/dense_2/kernel:0, ...
// Nothing else of a file is read, and neither code nor further files that it may name.
#pragma once

#include <string>
#include <vector>

#include "network/tensor.h"

namespace pbnbrdf {

struct KerasDenseLayer {
  std::string name;  // "dense_1"
  Tensor kernel, bias;
};

// The layers dense_1, dense_2, ... up to the first that is missing; float32 or float64 of either
// byte order, stored contiguously. Throws Error if the file is missing, larger than
// kMaxWeightFileSize, not HDF5 or damaged, or if a layer's dataset is missing or of another type.
// May be called from several threads at once: calls take turns, as HDF5 isn't thread-safe. If this
// is the first use of HDF5 in a program, HDF5 won't close what the program itself leaves open.
std::vector<KerasDenseLayer> ReadKerasDenseLayers(const std::string& path);

// The bytes of a file as Keras 2 saved weights: float32, contiguous, with the attributes that its
// load_weights() looks for (layer_names, weight_names, backend, keras_version), and the empty group
// lambda_1 of NBRDF's last layer, exp(x) - 1. layers: of the names dense_1, dense_2, ... Calls take
// turns, as above. Throws Error if HDF5 fails.
std::string KerasH5Bytes(const std::vector<KerasDenseLayer>& layers);

}  // namespace pbnbrdf
