// npy.h: NumPy's file format for one array, versions 1 to 3: "\x93NUMPY", a version, the header's
// length, the header {'descr': '<f4', 'fortran_order': False, 'shape': (6, 21), }, the elements.
#pragma once

#include <string>

#include "network/tensor.h"

namespace pbnbrdf {

// Reads little-endian float32 and float64 ('<f4', '<f8') in either order. Throws Error if the file
// is missing, larger than kMaxWeightFileSize, of another type, or longer or shorter than its header
// says.
Tensor ReadNpy(const std::string& path);

// The bytes of a file that holds the tensor as '<f4' in C order, version 1, the elements at a
// multiple of 64 as numpy.save puts them. Values are rounded to float32.
std::string NpyBytes(const Tensor& tensor);

}  // namespace pbnbrdf
