#include "hard_pairs.h"

#include "base/pi.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

void AddGrid(const std::vector<double>& thetas, const std::vector<double>& phis,
             std::vector<DirectionPair>* pairs) {
  for (double theta_h : thetas) {
    for (double theta_d : thetas) {
      for (double phi_d : phis) {
        pairs->push_back(FromAngles({.theta_h = theta_h, .theta_d = theta_d, .phi_d = phi_d}));
      }
    }
  }
}

}  // namespace

std::vector<DirectionPair> CornerPairs() {
  std::vector<DirectionPair> pairs;
  AddGrid({0.0, 0.5 * kPi}, {0.0, 0.5 * kPi, kPi, 1.5 * kPi}, &pairs);
  return pairs;
}

std::vector<DirectionPair> HardPairs() {
  std::vector<DirectionPair> pairs = CornerPairs();
  AddGrid({0.0, 1e-300, 1e-12, 1e-6, 0.25 * kPi, 0.5 * kPi - 1e-12, 0.5 * kPi},
          {0.0, 1e-12, 0.25 * kPi, kPi, 2.0 * kPi - 1e-12}, &pairs);
  const Vec3 directions[] = {
      {0.0, 0.0, 1.0},  {1.0, 0.0, 0.0},  {0.0, -1.0, 0.0},           {0.6, 0.0, 0.8},
      {0.0, 0.6, -0.8}, {0.0, 0.0, -1.0}, FromSpherical(1.5707, 2.0), FromSpherical(1.5709, 4.0)};
  for (const Vec3& wi : directions) {
    for (const Vec3& wo : directions) pairs.push_back({wi, wo});
    pairs.push_back({wi, -1.0 * wi});
  }
  return pairs;
}

}  // namespace pbnbrdf
