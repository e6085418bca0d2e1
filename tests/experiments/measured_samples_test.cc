#include "measured_samples.h"

#include <cmath>
#include <set>

#include "brdf/value_at.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/problem/sampling.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

// The value says which sample it is.
ScatteredBrdf Numbered(const std::vector<double>& angles, int at_each) {
  ScatteredData data;
  double number = 0.0;
  for (double theta_i : angles) {
    for (int k = 0; k < at_each; ++k) {
      const Vec3 wo = FromSpherical(0.1 + 1.2 * k / at_each, 1.7 * k);
      data.samples.push_back({{FromSpherical(theta_i, 0.0), wo}, {++number, 0.0, 0.0}});
    }
  }
  return ScatteredBrdf(std::move(data));
}

TEST(MeasuredSamples, AtAnAngleAreTheMeasurementsThere) {
  const ScatteredBrdf list = Numbered({0.3, 0.6, 0.9}, 20);
  const auto samples = SamplesAtAngle(list, 0.6, 5);
  ASSERT_EQ(samples.size(), 20u);
  for (const BrdfSample& s : samples) EXPECT_NEAR(std::acos(s.pair.wi.z), 0.6, 1e-9);
}

TEST(MeasuredSamples, AtAnAngleOfAFormulaAreRandomOnes) {
  const LambertBrdf diffuse({0.5, 0.5, 0.5});
  const auto samples = SamplesAtAngle(diffuse, 0.6, 50);
  ASSERT_EQ(samples.size(), 50u);
  for (const BrdfSample& s : samples) {
    EXPECT_NEAR(std::acos(s.pair.wi.z), 0.6, 1e-9);
    EXPECT_GT(s.pair.wo.z, 0.0);
  }
}

TEST(MeasuredSamples, WhatIsMeasuredOnIsNotTrainedOn) {
  const ScatteredBrdf list = Numbered({0.3, 0.6, 0.9}, 40);
  std::set<double> seen;
  for (const BrdfSample& s : TrainingMeasurements(list)) seen.insert(s.value[0]);
  const auto held_out = SamplesAtMeasured(list, 1);
  EXPECT_EQ(held_out.size(), 15u);
  EXPECT_EQ(seen.size() + held_out.size(), 120u);
  const std::unique_ptr<Brdf> values = AsInterpolated(list);
  EXPECT_TRUE(values->Measurements().empty());
  for (const BrdfSample& s : held_out) {
    EXPECT_EQ(seen.count(s.value[0]), 0u);
    EXPECT_NE(ValueAt(*values, s.pair), s.value);
  }
}

TEST(MeasuredSamples, PlainInterpolationIsTheNearestMeasurement) {
  const ScatteredBrdf list = Numbered({0.3, 0.6, 0.9}, 20);
  const std::unique_ptr<Brdf> plain = PlainInterpolation(list);
  for (const BrdfSample& s : list.Measurements()) {
    const Vec3 beside =
        FromSpherical(std::acos(s.pair.wo.z) + 1e-4, std::atan2(s.pair.wo.y, s.pair.wo.x));
    EXPECT_EQ(ValueAt(*plain, {s.pair.wi, beside}), s.value);
    EXPECT_EQ(ValueAt(*plain, {beside, s.pair.wi}), s.value);
  }
  const LambertBrdf diffuse({0.5, 0.5, 0.5});
  const DirectionPair pair = {{0, 0, 1}, {0.6, 0, 0.8}};
  EXPECT_EQ(ValueAt(*PlainInterpolation(diffuse), pair), ValueAt(diffuse, pair));
}

TEST(MeasuredSamples, FloorOfAListIsHalfOfWhatRepetitionsDiffer) {
  const DirectionPair pair = {FromSpherical(0.3, 0.0), FromSpherical(0.6, 2.0)};
  ScatteredData data;
  data.samples = {{pair, {1, 1, 1}}, {Swapped(pair), {3, 3, 3}}};
  const double cos_0 = std::cos(0.3), cos_1 = std::cos(0.6);
  const double expected =
      (std::log((1 + 3 * cos_0) / (1 + cos_0)) + std::log((1 + 3 * cos_1) / (1 + cos_1))) / 4;
  EXPECT_NEAR(MeasuredFloor(ScatteredBrdf(data), {}), expected, 1e-9);
  EXPECT_TRUE(std::isnan(MeasuredFloor(Numbered({0.3, 0.6}, 20), {})));
}

}  // namespace
}  // namespace pbnbrdf
