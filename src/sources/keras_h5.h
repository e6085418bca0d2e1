// keras_h5.h: the weights of dense layers in an HDF5 file that Keras wrote. A layer is a group, however deep, that
// holds its kernel (in x out) and bias (out):
//
//   kernel:0, bias:0   weights of Keras 2, /dense_1/dense_1/, or of a whole model, /model_weights/dense_1/...
//   vars/0, vars/1     weights of Keras 3, /layers/dense_1/vars/, also within a .keras archive
//
// Their order is that of the attribute layer_names. Where there is none, layers must be of one name but for a number
// at its end, which is then their order; none is 0.
// Nothing else of a file is read, and neither code nor further files that it may name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "network/tensor.h"

namespace pbnbrdf {

// How each HDF5 file begins.
inline constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";

struct KerasDenseLayer {
  std::string name;  // "dense_1" to write, "/dense_1/dense_1" when read
  Tensor kernel, bias;
  std::string kernel_name = "kernel:0", bias_name = "bias:0";
};

// The layers in order; float32 or float64 of either byte order, stored contiguously. Throws Error if the
// file is missing, larger than kMaxWeightFileSize, not HDF5 or damaged, if there are no layers or their order
// isn't known, or if a layer's dataset is missing or of another type.
// May be called from several threads at once: calls take turns, as HDF5 isn't thread-safe. If this
// is the first use of HDF5 in a program, HDF5 won't close what the program itself leaves open.
std::vector<KerasDenseLayer> ReadKerasDenseLayers(const std::string& path);

// The bytes of a file as Keras 2 saved weights: float32, contiguous, with the attributes that its
// load_weights() looks for (layer_names, weight_names, backend, keras_version), and the empty group
// lambda_1 of NBRDF's last layer, exp(x) - 1. layers: of the names dense_1, dense_2, ... Calls take
// turns, as above. Throws Error if HDF5 fails.
std::string KerasH5Bytes(const std::vector<KerasDenseLayer>& layers);

}  // namespace pbnbrdf
