#include "discontinuity.h"

#include <cmath>

#include "base/pi.h"
#include "image/srgb.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = kPi / 180.0;

double ShownDifference(const Brdf& brdf, double theta_h, double theta_d) {
  const DirectionPair pairs[] = {
      FromAngles({.theta_h = theta_h, .theta_d = theta_d, .phi_d = 0.0}),
      FromAngles({.theta_h = theta_h, .theta_d = theta_d, .phi_d = kPi})};
  if (!pairs[0].AboveHorizon() || !pairs[1].AboveHorizon()) return 0.0;
  Rgb values[2];
  brdf.Evaluate(pairs, values);
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    // Both stand for the pair with the light at wi.
    const double lit = kPi * pairs[0].wi.z;
    sum += std::abs(ToSrgb(lit * values[0][c]) - ToSrgb(lit * values[1][c])) / 3.0;
  }
  return sum;
}

}  // namespace

void FoldedBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                   std::span<Rgb> values) const {
  std::vector<DirectionPair> folded(pairs.begin(), pairs.end());
  for (DirectionPair& pair : folded) {
    if (ToHalfDiff(pair).d.y < 0.0) pair = Swapped(pair);
  }
  brdf_->EvaluateUnclipped(folded, values);
}

Discontinuity WorstDiscontinuity(const Brdf& brdf) {
  Discontinuity worst;
  for (double theta_d = 5.0; theta_d <= 45.0; theta_d += 2.5) {
    double sum = 0.0;
    int count = 0;
    for (double theta_h = 1.0; theta_h <= 40.0; theta_h += 1.0, ++count) {
      sum += ShownDifference(brdf, theta_h * kDegree, theta_d * kDegree);
    }
    if (sum / count > worst.jump) worst = {theta_d * kDegree, sum / count};
  }
  return worst;
}

}  // namespace pbnbrdf
