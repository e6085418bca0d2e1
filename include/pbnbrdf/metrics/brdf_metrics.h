// brdf_metrics.h: how well one Brdf reproduces another, and how physical it is.
#pragma once

#include <cstdint>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// Means over random pairs at which the reference is known: theta_h, theta_d uniform in [0, pi/2],
// phi_d in [0, 2 pi), as phi_h if the reference is anisotropic; never those of a training set
// (brdf/sampling.h).
struct HeldOutErrors {
  double mean_abs_log_error = 0.0;  // eq. 6 in absolute value, mean over channels too
  double chromaticity_error = 0.0;  // eq. 7 in absolute value
  double rmse = 0.0;                // of f cos_i, 1/sr, over channels too
  std::size_t samples = 0;
};

// samples >= 1. Throws Error if the reference has next to no data.
HeldOutErrors MeasureErrors(const Brdf& reference, const Brdf& test, std::size_t samples,
                            std::uint64_t seed);

// Mean over the whole domain of angles, below the horizon too, and channels, by the midpoint rule
// with theta_h = (pi/2) t^2; over phi_h too if the Brdf is anisotropic. phi_d + pi is the exchange
// of wi and wo.
struct Reciprocity {
  double hrl = 0.0;  // eq. 8: mean square of f(phi_d) - f(phi_d + pi), phi_d in [0, pi]
  double hcl = 0.0;  // eq. 9: mean |f(0) - f(pi)|
};

Reciprocity MeasureReciprocity(const Brdf& brdf);

// From the directional albedos at incident angles 0.5, 1.5, ..., 89.5 degrees.
struct Energy {
  double max_directional_albedo = 0.0;  // over angles and channels
  double eal = 0.0;                     // eq. 5, mean over channels, sr
};

Energy MeasureEnergy(const Brdf& brdf);

}  // namespace pbnbrdf
