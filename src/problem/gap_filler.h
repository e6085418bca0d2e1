// gap_filler.h: values between and beyond scattered measurements, for fits.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {

// An analytic model, a lobe of GGX or two and a diffuse part, is fitted to the measurements and corrected by them:
// the ratio (f + 0.03) / (model + 0.03) is interpolated between them as scattered.h says, and becomes 1 far
// from them. What a scan in one plane says of directions beside the plane is thus what a lobe that fits the
// scan has there.
class GapFiller {
 public:
  // measurements: at least one.
  GapFiller(std::span<const BrdfSample> measurements, bool isotropic);

  // The values at pairs above the horizon, weighted by their certainty, at least kMinWeight.
  std::vector<BrdfSample> At(const std::vector<DirectionPair>& pairs) const;
  static constexpr double kMinWeight = 0.5;

 private:
  AnalyticBrdf model_;
  ScatteredBrdf ratios_;
};

}  // namespace pbnbrdf
