// evaluation.h: what stands before and behind a network when it is evaluated in single precision,
// for batches of kBatch directions; compiled for several instruction sets (kernels.h).
#pragma once

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// A batch of direction pairs as inputs of a network, in the encodings of network/encoding.h.
//   pairs: (wi.x, wi.y, wi.z, wo.x, wo.y, wo.z) of kBatch pairs, unit vectors.
//   inputs: by feature, 6 x kBatch; relative errors a few units in the last place of float, absolute
//   ones where an input changes sign; the first input of EncodeMerl and EncodeBilateral to 1e-4.
// All but EncodeCartesian give the same bits when wi and wo are exchanged.
void EncodeCartesian(const double* pairs, float* inputs);
void EncodeReciprocal(const double* pairs, float* inputs);
void EncodeMultiscale(const double* pairs, float* inputs);
void EncodeMerl(const double* pairs, float* inputs);
void EncodeBilateral(const double* pairs, float* inputs);
void EncodeAnisotropic(const double* pairs, float* inputs);

// f = expm1(z), clamped to [0, largest], 0 where z is NaN; to a few units in the last place of float.
//   z: by feature, 3 x kBatch.  f: by sample, kBatch x 3.  largest < 1e37.
void Reflectances(const float* z, float largest, double* f);

}  // namespace pbnbrdf::kernels
