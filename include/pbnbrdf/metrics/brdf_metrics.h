// brdf_metrics.h: how well one Brdf reproduces another, and how physical it is.
#pragma once

#include <cstddef>
#include <span>

#include "pbnbrdf/brdf/albedo.h"

namespace pbnbrdf {

// Means over samples of a reference, such as HeldOutSamples (problem/sampling.h).
struct HeldOutErrors {
  double mean_abs_log_error = 0.0;  // eq. 6 in absolute value, mean over channels too
  double chromaticity_error = 0.0;  // eq. 7 in absolute value
  double rmse = 0.0;                // of f cos_i, 1/sr, over channels too
  // The mean absolute error of f cos_i over its mean absolute value: 1 for a fit of 0.
  double relative_error = 0.0;
  std::size_t samples = 0;
};

// reference: at least one sample.
HeldOutErrors MeasureErrors(std::span<const BrdfSample> reference, const Brdf& test);

// Half the mean of |log1p(f(wi, wo) cos_i) - log1p(f(wo, wi) cos_i)| over samples of a material and
// channels: the least mean absolute log error that a reciprocal fit can have there. 0 if the material is
// reciprocal.
double ReciprocalFloor(std::span<const BrdfSample> samples, const Brdf& material);

// On the same samples the lit colour: what a display shows of the surface under one directional D65
// light in which a white diffuse surface that faces it is white, pi f cos_i as linear RGB, cut to
// [0, 1]. 95th percentile: the least value that 95 % of the samples don't exceed.
struct ColorErrors {
  double delta_e_mean = 0.0, delta_e_p95 = 0.0;  // CIE Delta E 2000 (color.h)
  // sqrt(da^2 + db^2) of CIELAB, where the reference's lit luminance is at most 0.1 of white's: the
  // dark colours whose tint small errors change. 0 where there is no such sample.
  double dark_hue_chroma_mean = 0.0, dark_hue_chroma_p95 = 0.0;
  std::size_t samples = 0, dark_samples = 0;
};

// As MeasureErrors. A value that isn't finite makes the mean NaN.
ColorErrors MeasureColorErrors(std::span<const BrdfSample> reference, const Brdf& test);

// Mean over the whole domain of angles, below the horizon too, and channels, by the midpoint rule
// with theta_h = (pi/2) t^2; over phi_h too if the Brdf is anisotropic. phi_d + pi is the exchange
// of wi and wo. Above the horizon, where f isn't known in both orders, the difference counts as 0.
struct Reciprocity {
  double hrl = 0.0;  // eq. 8: mean square of f(phi_d) - f(phi_d + pi), phi_d in [0, pi]
  double hcl = 0.0;  // eq. 9: mean |f(0) - f(pi)|
};

Reciprocity MeasureReciprocity(const Brdf& brdf);

// From the directional albedos at incident directions all over the hemisphere (brdf/albedo.h).
struct Energy {
  double max_directional_albedo = 0.0;  // over incident directions and channels
  double theta_i = 0.0, phi_i = 0.0;    // where it is, radians
  int channel = 0;                      // and in which: 0, 1, 2
  double eal = 0.0;                     // eq. 5, mean over channels, sr

  // Whether no directional albedo is above 1, as far as these quadratures tell.
  bool Conserved() const { return max_directional_albedo <= 1.0 + kTolerance; }
  static constexpr double kTolerance = 1e-6;
};

Energy MeasureEnergy(const Brdf& brdf, const AlbedoGrid& grid = {});

// Of a profile that is known already.
Energy EnergyOf(const std::vector<IncidentAlbedo>& profile);

}  // namespace pbnbrdf
