// losses.h: terms of the objective and their gradients, from a network's outputs z. Layouts and T:
// kernels.h.
#pragma once

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// The log term (eq. 6) and its derivative, in double precision: with u_c = expm1(z_c) cos_i,
//   residuals_c = targets_c - log1p(u_c),  slopes_c = d residuals_c / d z_c.
// By feature, 3 x kBatch; cos_i kBatch. Residuals aren't finite where z isn't, nor
// where it is above 706 and cos_i < 1.
template <typename T>
void LogResiduals(const T* z, const double* targets, const double* cos_i, double* residuals,
                  double* slopes);

// The gradient with respect to z of, for each of kBatch samples,
//
//   log_weight * sum_c |log1p(f_c cos_i) - log1p(f^_c cos_i)|
//     + chromaticity_weight * |log1p(|f cos_i|^2) - log1p(|f^ cos_i|^2)|,   f^_c = expm1(z_c),
//
// eqs. 6 and 7; 0 where cos_i = 0, and where z_c > 40 what it is at 40. By feature: z, f and gradient
// 3 x kBatch, cos_i kBatch, in [0, 1].
template <typename T>
void AbsoluteLossGradient(const T* z, const T* cos_i, const T* f, T log_weight,
                          T chromaticity_weight, T* gradient);

// sums[c] += the sum over kBatch samples of weights[n] max(0, expm1(z[c][n])), c < 3: a part of a
// directional albedo. By feature: z 3 x kBatch.
template <typename T>
void AddReflectanceSums(const T* z, const T* weights, T* sums);

}  // namespace pbnbrdf::kernels
