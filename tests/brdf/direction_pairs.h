// direction_pairs.h: pairs of directions for property tests: the hard ones, and random ones.
#pragma once

#include <random>
#include <vector>

#include "pbnbrdf/brdf/half_diff.h"
#include "test_util.h"

namespace pbnbrdf {

// wi == wo, normal incidence, exact mirror pairs, grazing, in the plane of incidence and across.
inline std::vector<DirectionPair> HardPairs() {
  std::vector<DirectionPair> pairs;
  for (double theta : {0.0, 1e-9, 0.3, 1.2, kPi / 2 - 1e-6}) {
    for (double phi : {0.0, 1.0, kPi, 4.0}) {
      const Vec3 w = FromSpherical(theta, phi);
      pairs.push_back({w, w});
      pairs.push_back({w, {0.0, 0.0, 1.0}});
      pairs.push_back({w, {-w.x, -w.y, w.z}});
      pairs.push_back({w, FromSpherical(0.7, phi + kPi / 2)});
      pairs.push_back({w, FromSpherical(kPi / 2 - 1e-6, phi + 3.0)});
    }
  }
  return pairs;
}

// Uniform in the solid angle above the horizon.
inline std::vector<DirectionPair> RandomPairs(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto direction = [&] {
    return FromSpherical(std::acos(uniform(random)), 2.0 * kPi * uniform(random));
  };
  std::vector<DirectionPair> pairs(count);
  for (DirectionPair& pair : pairs) pair = {direction(), direction()};
  return pairs;
}

inline Vec3 Turned(const Vec3& w, double phi) {
  const double c = std::cos(phi), s = std::sin(phi);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

// Both directions turned about the normal.
inline DirectionPair Turned(const DirectionPair& pair, double phi) {
  return {Turned(pair.wi, phi), Turned(pair.wo, phi)};
}

inline std::vector<DirectionPair> HardAndRandomPairs(std::size_t count, unsigned seed) {
  std::vector<DirectionPair> pairs = HardPairs();
  const std::vector<DirectionPair> random = RandomPairs(count, seed);
  pairs.insert(pairs.end(), random.begin(), random.end());
  return pairs;
}

}  // namespace pbnbrdf
