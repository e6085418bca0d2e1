#include "database/even_pairs.h"

#include <algorithm>
#include <cmath>

#include "base/pi.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {

std::array<double, 3> EvenPoint(int n) {
  constexpr std::array<double, 3> kSteps = {0.8191725133961645, 0.6710436067037893,
                                            0.5497004779019703};
  std::array<double, 3> point;
  for (std::size_t k = 0; k < point.size(); ++k) point[k] = std::fmod(n * kSteps[k], 1.0);
  return point;
}

std::vector<DirectionPair> EvenPairs(std::size_t count, double smallest_cosine) {
  std::vector<DirectionPair> pairs;
  for (int n = 1; pairs.size() < count; ++n) {
    const auto [h, d, p] = EvenPoint(n);
    const DirectionPair pair =
        FromAngles({.theta_h = 0.5 * kPi * h, .theta_d = 0.5 * kPi * d, .phi_d = 2.0 * kPi * p});
    if (std::min(pair.wi.z, pair.wo.z) > smallest_cosine) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace pbnbrdf
