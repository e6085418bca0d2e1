// sample_weights.h: how much each of several measurements counts in a fit, by its standard deviation.
//
// Residuals are differences of log1p(f cos_i). There, a standard deviation sigma of f (1/sr) is to first order
//
//   s = sigma cos_i / (1 + f cos_i),   f the mean of the channels.
//
// A measurement has the weight min(1, (m / s)^2), m the median of all s, and at least kLeastWeight: those that
// are known worse than the median count less, and none counts so much that the fit follows it alone.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

inline constexpr double kLeastWeight = 1e-4;

// sigmas: one for each sample, finite and >= 0. Samples below the horizon keep their weight.
void SetWeights(std::span<const double> sigmas, std::span<BrdfSample> samples);

}  // namespace pbnbrdf
