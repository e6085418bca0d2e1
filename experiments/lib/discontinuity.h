// discontinuity.h: the jump that pictures of networks that aren't reciprocal show (figure 1 of the paper).
#pragma once

#include <memory>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// An isotropic f that is only asked at phi_d from 0 to pi, as MERL's tables and what reads them have it: beyond, the
// directions are exchanged. If f isn't reciprocal, this jumps where wi, wo and the normal are in one plane.
class FoldedBrdf final : public Brdf {
 public:
  explicit FoldedBrdf(std::unique_ptr<Brdf> brdf) : brdf_(std::move(brdf)) {}

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  std::string Description() const override { return brdf_->Description() + ", phi_d folded"; }

 private:
  std::unique_ptr<Brdf> brdf_;
};

// Where a sphere under one light shows the jump most.
struct Discontinuity {
  double theta_d = 0.0;  // radians: half the angle between light and viewer
  double jump = 0.0;     // mean difference of the shown values, 0 to 1, along the line where it is
};

// brdf: not folded. Over theta_d up to 45 degrees; the line from the highlight on to 40 degrees from it, in a light
// in which a white diffuse surface is white.
Discontinuity WorstDiscontinuity(const Brdf& brdf);

}  // namespace pbnbrdf
