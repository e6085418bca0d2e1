// code_fit.h: the code of a material that isn't in the database, from a few measurements.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/network/weight_family.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// Standard deviations of what the best code doesn't explain: of log(1 + f cos theta_i); of the mapped values of
// table_pca.h.
inline constexpr double kFamilyNoise = 0.01, kPcaNoise = 0.1;

// The likeliest code of a shared network: the least
//
//   1 / (2 noise^2) * sum over samples of rho(|r|^2)  +  |code|^2 / 2,
//
// r the residuals of the log term (eq. 6), rho the loss soft_l1 of scale `noise`: what residuals the best code
// would leave. Starts at the mean and at the members that explain the samples best. samples: at least one.
std::vector<double> FitCode(const WeightFamily& family, std::span<const BrdfSample> samples,
                            double noise = kFamilyNoise);

// The expected code of principal components, 3 K numbers, by Gaussian process regression [1] channel by channel, the
// mapped values' noise having the standard deviation `noise`. Materials are like those that they resemble: the codes'
// mean and covariance are taken over the members' channels and, for what is like a formula and like no member, over 400
// lobes of microfacet models above diffuse grounds. Each is weighted by
//
//   exp(-d / (2 h^2)),  d: the mean squared distance of its mapped values from the samples',
//
// and what h = 0.25, 0.5 and 1 give is averaged. (Nielsen et al. 2015 have the same covariance for all: ridge
// regression.)
//
// [1] C. Rasmussen, C. Williams. Gaussian Processes for Machine Learning. MIT Press 2006, chapter 2.
std::vector<double> FitCode(const TablePca& pca, std::span<const BrdfSample> samples,
                            double noise = kPcaNoise);

}  // namespace pbnbrdf
