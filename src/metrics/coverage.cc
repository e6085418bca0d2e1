#include "pbnbrdf/metrics/coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "base/median.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/uniform.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kPairs = 10000;      // of random directions
constexpr std::size_t kNeighbours = 1000;  // measurements whose neighbours are looked for
// Sine of the angle between a direction and the plane: rounding of text.
constexpr double kInPlane = 1e-3;
// From the normal, radians: nearer to the horizon any highlight gets very bright.
constexpr double kNearNormal = kPi / 3.0;
constexpr double kNormalMedian = 0.6745;  // of |x|, where x has a standard deviation of 1

// Uniform in solid angle.
Vec3 RandomDirection(std::mt19937_64& random) {
  const double theta = std::acos(Uniform(random));
  return FromSpherical(theta, 2.0 * kPi * Uniform(random));
}

// Whether both directions are in a plane with the normal.
bool IsInPlane(const DirectionPair& pair) {
  const auto& [wi, wo] = pair;
  return std::abs(wi.x * wo.y - wi.y * wo.x) <= kInPlane * std::hypot(wi.x, wi.y);
}

// Where highlights are, a degree of incidence apart.
void AddMirrorPairs(const Brdf& material, std::vector<DirectionPair>* pairs) {
  for (double theta = kPi / 180.0; theta < kNearNormal; theta += kPi / 180.0) {
    const DirectionPair pair = {FromSpherical(theta, 0.0), FromSpherical(theta, kPi)};
    if (material.IsKnown(pair)) pairs->push_back(pair);
  }
}

bool IsNearNormal(const DirectionPair& pair) {
  return std::min(pair.wi.z, pair.wo.z) > std::cos(kNearNormal);
}

double LargestNearNormal(const std::vector<DirectionPair>& pairs, const std::vector<Rgb>& values) {
  double largest = 0.0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (IsNearNormal(pairs[n])) largest = std::max(largest, Largest(values[n]));
  }
  return largest;
}

bool HasNegative(const Rgb& value) {
  return std::any_of(value.begin(), value.end(), [](double v) { return v < 0.0; });
}

// The standard deviation of normally distributed numbers, by the median of their absolute values.
double Deviation(std::vector<double> absolute) {
  return absolute.empty() ? 0.0 : Median(std::move(absolute)) / kNormalMedian;
}

// Of measurements and the nearest other ones.
double NoiseOfList(const std::vector<BrdfSample>& measured, bool isotropic) {
  std::vector<std::array<double, 4>> places;
  for (const BrdfSample& sample : measured) places.push_back(MirroredPlace(sample.pair, isotropic));
  const std::size_t step = measured.size() / kNeighbours + 1, count = measured.size() / step;
  std::vector<Rgb> differences(count);
  ParallelFor(count, [&](std::size_t k) {
    const std::size_t n = k * step;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < measured.size(); ++m) {
      double squares = 0.0;
      for (int i = 0; i < 4; ++i) squares += std::pow(places[m][i] - places[n][i], 2);
      if (m == n || !(squares < least)) continue;
      least = squares;
      for (int c = 0; c < 3; ++c) {
        differences[k][c] = std::abs(measured[m].value[c] - measured[n].value[c]) / std::sqrt(2.0);
      }
    }
  });
  std::vector<double> all;
  for (const Rgb& rgb : differences) all.insert(all.end(), rgb.begin(), rgb.end());
  return Deviation(std::move(all));
}

// Second differences over phi_d, a degree apart, where all three values are known.
double NoiseOfTable(const Brdf& material, const std::vector<DirectionPair>& pairs) {
  constexpr double kStep = kPi / 180.0;
  std::vector<DirectionPair> before, after;
  std::vector<std::size_t> used;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    RusinkiewiczAngles angles = ToAngles(pairs[n]);
    angles.phi_d -= kStep;
    const DirectionPair first = FromAngles(angles);
    angles.phi_d += 2.0 * kStep;
    const DirectionPair last = FromAngles(angles);
    if (!material.IsKnown(first) || !material.IsKnown(last)) continue;
    before.push_back(first);
    after.push_back(last);
    used.push_back(n);
  }
  std::vector<DirectionPair> middle;
  for (std::size_t n : used) middle.push_back(pairs[n]);
  std::vector<Rgb> a(used.size()), b(used.size()), c(used.size());
  material.EvaluateUnclipped(before, a);
  material.EvaluateUnclipped(middle, b);
  material.EvaluateUnclipped(after, c);
  std::vector<double> all;
  for (std::size_t n = 0; n < used.size(); ++n) {
    for (int k = 0; k < 3; ++k) {
      all.push_back(std::abs(a[n][k] - 2.0 * b[n][k] + c[n][k]) / std::sqrt(6.0));
    }
  }
  return Deviation(std::move(all));
}

}  // namespace

Coverage MeasureCoverage(const Brdf& material) {
  std::mt19937_64 random(1);
  std::vector<DirectionPair> known;
  for (std::size_t n = 0; n < kPairs; ++n) {
    const Vec3 wi = RandomDirection(random);
    const DirectionPair pair = {wi, RandomDirection(random)};
    if (material.IsKnown(pair)) known.push_back(pair);
  }
  Coverage coverage = {.known = static_cast<double>(known.size()) / kPairs};
  std::vector<Rgb> values;
  const std::vector<BrdfSample> measured = material.Measurements();
  if (measured.empty()) {
    coverage.noise = NoiseOfTable(material, known);
    AddMirrorPairs(material, &known);
    values.resize(known.size());
    material.EvaluateUnclipped(known, values);
  } else {
    known.clear();
    for (const auto& [pair, value, weight] : measured) {
      known.push_back(pair);
      values.push_back(value);
    }
    coverage.in_plane = std::all_of(known.begin(), known.end(), IsInPlane);
    coverage.noise = NoiseOfList(measured, material.IsIsotropic());
  }
  coverage.largest = LargestNearNormal(known, values);
  const auto negative = std::count_if(values.begin(), values.end(), HasNegative);
  coverage.negative =
      static_cast<double>(negative) / static_cast<double>(std::max<std::size_t>(values.size(), 1));
  return coverage;
}

}  // namespace pbnbrdf
