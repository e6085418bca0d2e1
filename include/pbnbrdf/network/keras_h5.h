// keras_h5.h: the weights of dense layers in an HDF5 file that Keras wrote: the datasets
// /dense_1/dense_1/kernel:0 (in x out), /dense_1/dense_1/bias:0 (out), /dense_2/dense_2/kernel:0, ...
// Nothing else of the file is read, and neither code nor further files that it may name.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/network/tensor.h"

namespace pbnbrdf {

struct KerasDenseLayer {
  std::string name;  // "dense_1"
  Tensor kernel, bias;
};

// The layers dense_1, dense_2, ... up to the first that is missing; float32 or float64 of either
// byte order, stored contiguously. Throws Error if the file is missing, larger than
// kLargestWeightFile, not HDF5 or damaged, or if a layer's dataset is missing or of another type.
// May be called from several threads at once: calls take turns, as HDF5 isn't thread-safe. If this
// is the first use of HDF5 in a program, HDF5 won't close what the program itself leaves open.
std::vector<KerasDenseLayer> ReadKerasDenseLayers(const std::string& path);

}  // namespace pbnbrdf
