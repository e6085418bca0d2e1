// gap_filler.h: values between and beyond scattered measurements, for fits.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// A model is corrected by the measurements: the ratio (f + 0.03) / (model + 0.03) is interpolated between them
// as scattered.h says, and becomes 1 far from them. Unless another is given, the model is an analytic one, a
// lobe of GGX or two and a diffuse part, fitted to the measurements. What a scan in one plane says of directions
// beside the plane is thus what a lobe that fits the scan has there.
class GapFiller {
 public:
  // measurements: at least one. model: null for the analytic one.
  GapFiller(std::span<const BrdfSample> measurements, bool isotropic,
            std::shared_ptr<const Brdf> model);

  // The values at pairs above the horizon, weighted by their certainty, at least kMinWeight.
  std::vector<BrdfSample> At(const std::vector<DirectionPair>& pairs) const;
  static constexpr double kMinWeight = 0.5;

 private:
  std::shared_ptr<const Brdf> model_;
  ScatteredBrdf ratios_;
};

}  // namespace pbnbrdf
