// nbrdf_files.h: the networks that Sztrajman et al. published [1], as Keras or NumPy files:
//
//   x = (h, d), h = (sin theta_h, 0, cos theta_h), d the difference vector: Encoding::kCartesian
//   a1 = relu(x K1 + b1),  a2 = relu(a1 K2 + b2),  f = max(0, exp(a2 K3 + b3) - 1), 1/sr
//
// Their kernels K are in x out, the transpose of W in network_shape.h. Hidden layers may be of any
// size. The architecture that Keras stores beside the weights is never read: its last layer is
// serialised program code.
//
// [1] Sztrajman, Rainer, Ritschel, Weyrich. Neural BRDF Representation and Importance Sampling.
//     Computer Graphics Forum 40(6), 2021.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/base/files.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// Whether the name is one that ReadNbrdf reads: it ends with ".h5", ".hdf5", ".keras" or ".npy".
bool IsNbrdfFile(const std::string& path);

// Whether a file that begins so is one of HDF5, of ZIP or of NumPy.
bool LooksLikeNbrdf(std::string_view start);

// An HDF5 file, or a ZIP archive with one, as Keras 3 saves models: datasets as in keras_h5.h.
// "BASEfc1.npy", where BASE may end a folder's name or be like "folder/blue-acrylic_": the six files
// BASEfc1.npy (6 x H1), BASEfc2.npy (H1 x H2), BASEfc3.npy (H2 x 3), BASEb1.npy (H1), BASEb2.npy (H2)
// and BASEb3.npy (3). Throws Error if one is missing, larger than kMaxWeightFileSize, damaged, of
// another shape or type, or holds a value that isn't finite.
NeuralBrdf ReadNbrdf(const std::string& path);

// What ReadNbrdf reads from the same name, as float32: one Keras file or six NumPy files. Throws
// Error if the network hasn't relu units and the cartesian encoding, if a weight is beyond
// float32, or if NumPy files are asked for and there are not two hidden layers.
std::vector<FileContent> NbrdfFiles(const NeuralBrdf& network, const std::string& path);

// The files that ReadNbrdf reads for this name: the six NumPy files for "BASEfc1.npy", or the file itself.
std::vector<std::string> FilesReadWith(const std::string& path);

}  // namespace pbnbrdf
