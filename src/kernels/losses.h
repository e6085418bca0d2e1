// losses.h: terms of the objective and their gradients, from a network's outputs z, and the step of Adam.
// Layouts: kernels.h.
#pragma once

#include <cstddef>

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// The log term (eq. 6) and its derivative: with u_c = expm1(z_c) cos_i,
//   residuals_c = targets_c - log1p(u_c),  slopes_c = d residuals_c / d z_c.
// By feature, 3 x kBatch; cos_i kBatch. A residual is not finite where z is not, or
// where z is above 706 and cos_i < 1.
void LogResiduals(const double* z, const double* targets, const double* cos_i, double* residuals,
                  double* slopes);

// Each adds to gradient, for each of kBatch samples, weight times the gradient with respect to z of
//
//   sum_c |log1p(f_c cos_i) - log1p(f^_c cos_i)|        (eq. 6),
//   |log1p(|f cos_i|^2) - log1p(|f^ cos_i|^2)|          (eq. 7),   f^_c = expm1(z_c),
//
// 0 where cos_i = 0; z_c above 40 counts as 40. By feature: z, f and gradient 3 x kBatch, cos_i kBatch,
// in [0, 1].
void AddAbsoluteLogGradient(const float* z, const float* cos_i, const float* f, float weight,
                            float* gradient);
void AddAbsoluteChromaticityGradient(const float* z, const float* cos_i, const float* f,
                                     float weight, float* gradient);

// sums[c] += the sum over kBatch samples of weights[n] max(0, expm1(z[c][n])), c < 3: a part of a
// directional albedo. By feature: z 3 x kBatch.
void AddReflectanceSums(const float* z, const float* weights, float* sums);

// A step of Adam. The caller corrects the bias of mean and square, through rate and epsilon:
//   mean = beta1 mean + (1 - beta1) g,  square = beta2 square + (1 - beta2) g^2,
//   x -= rate mean / (sqrt(square) + epsilon).
// A mean or square below 1e-35 becomes 0. count: a multiple of kPad.
void AdamStep(std::size_t count, const float* gradient, float rate, float beta1, float beta2,
              float epsilon, float* mean, float* square, float* x);

}  // namespace pbnbrdf::kernels
