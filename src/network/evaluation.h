// evaluation.h: encodings and output unit in single precision, for batches of kernels::kBatch pairs;
// compiled for several instruction sets (kernels.h).
#pragma once

#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

// The inputs of a network, of kernels::kBatch pairs of unit vectors.
//   inputs: by feature, kEncodedSize x kBatch. Relative errors of a few units in the last place of
//   float, absolute ones where an input changes sign; the first input of Encoding::kMerl to 1e-4.
// The same bits when wi and wo are exchanged, if the encoding is reciprocal.
void EncodeBatch(Encoding encoding, const DirectionPair* pairs, float* inputs);

// f = ClampedReflectance(z), to a few units in the last place of float.
//   z: by feature, 3 x kBatch.  f: kBatch values.
void ReflectanceBatch(const float* z, Rgb* f);

}  // namespace pbnbrdf
