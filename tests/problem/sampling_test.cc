#include "pbnbrdf/problem/sampling.h"

#include <set>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

const LambertBrdf kGrey({0.5, 0.5, 0.5});

const WardBrdf kBrushed({0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.05, 0.2});

// Known nowhere, or almost.
class UnknownBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair>, std::span<Rgb> values) const override {
    for (Rgb& value : values) value = {};
  }
  bool IsKnown(const DirectionPair&) const override { return false; }
  std::string Description() const override { return "unknown"; }
};

using Key = std::array<double, 3>;
std::set<Key> ThetaDs(const std::vector<BrdfSample>& samples) {
  std::set<Key> keys;
  for (const BrdfSample& s : samples) {
    const RusinkiewiczAngles a = ToAngles(s.pair);
    keys.insert({a.theta_h, a.theta_d, a.phi_d});
  }
  return keys;
}

TEST(Sampling, AStreamGivesTheSameSamplesInAnyPortions) {
  std::vector<BrdfSample> samples;
  SampleStream stream(kGrey, SampleSet::kTraining, Sampling::kHighlight, 5);
  for (std::size_t count : {1, 0, 1500, 499, 1000}) stream.Draw(count, &samples);
  const auto all = DrawSamples(kGrey, SampleSet::kTraining, Sampling::kHighlight, 3000, 5);
  ASSERT_EQ(samples.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    ASSERT_EQ(samples[n].pair.wi.x, all[n].pair.wi.x) << n;
    ASSERT_EQ(samples[n].pair.wo.z, all[n].pair.wo.z) << n;
  }
}

// Measured at theta_i = 0.5 only, and negative.
class OnceMeasuredBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair>, std::span<Rgb> values) const override {
    for (Rgb& value : values) value = {-0.1, -0.1, 0.2};
  }
  double Certainty(const DirectionPair& pair) const override {
    return std::abs(std::acos(pair.wi.z) - 0.5) < 1e-9 ? 1.0 : 0.25;
  }
  std::optional<DirectionPair> NearestMeasured(const DirectionPair& pair) const override {
    return DirectionPair{FromSpherical(0.5, 0.0), pair.wo};
  }
  std::string Description() const override { return "measured once"; }
};

TEST(Sampling, TrainingHasAPartAtMeasuredDirectionsAndWeights) {
  const OnceMeasuredBrdf brdf;
  int measured = 0;
  const auto samples = DrawSamples(brdf, SampleSet::kTraining, Sampling::kUniform, 4000, 1);
  for (const BrdfSample& sample : samples) {
    const bool is_measured = brdf.Certainty(sample.pair) == 1.0;
    EXPECT_EQ(sample.weight, is_measured ? 1.0 : 0.5);
    EXPECT_EQ(sample.value[0], -0.1) << "negative measurements take part";
    measured += is_measured;
  }
  // More than 0.57, as some of the other pairs are below the horizon.
  EXPECT_NEAR(measured / 4000.0, 0.63, 0.06);
  for (const BrdfSample& sample : MovedToMeasured(brdf, HeldOutSamples(brdf, 100, 1))) {
    EXPECT_EQ(brdf.Certainty(sample.pair), 1.0);
  }
}

TEST(Sampling, SameSeedSameSamples) {
  const auto a = DrawSamples(kGrey, SampleSet::kTraining, Sampling::kHighlight, 1000, 5);
  const auto b = DrawSamples(kGrey, SampleSet::kTraining, Sampling::kHighlight, 1000, 5);
  const auto c = DrawSamples(kGrey, SampleSet::kTraining, Sampling::kHighlight, 1000, 6);
  EXPECT_EQ(ThetaDs(a), ThetaDs(b));
  EXPECT_NE(ThetaDs(a), ThetaDs(c));
  EXPECT_EQ(a.size(), 1000u);
}

TEST(Sampling, TrainingAndHeldOutSetsAreDisjointEvenForOneSeed) {
  // Both sets would be equal for the same seed if theta_d came from the same grid.
  const auto training = DrawSamples(kGrey, SampleSet::kTraining, Sampling::kUniform, 20000, 5);
  const auto held_out = DrawSamples(kGrey, SampleSet::kHeldOut, Sampling::kUniform, 20000, 5);
  const std::set<Key> a = ThetaDs(training), b = ThetaDs(held_out);
  for (const Key& key : a) EXPECT_EQ(b.count(key), 0u);
}

TEST(Sampling, OfAnAnisotropicBrdfTheSetsAreDisjointToo) {
  // Both draw theta_d first from the same seed; the nearest points of their grids are apart by
  // (pi / 2) 2^-32, far beyond the rounding of the directions.
  const auto training = DrawSamples(kBrushed, SampleSet::kTraining, Sampling::kUniform, 20000, 5);
  const auto held_out = DrawSamples(kBrushed, SampleSet::kHeldOut, Sampling::kUniform, 20000, 5);
  const auto parity = [](const BrdfSample& sample) {
    const double k = ToAngles(sample.pair).theta_d * 2.0 / kPi * 0x1p32 - 0.5;
    EXPECT_NEAR(k, std::round(k), 0.1);
    return static_cast<std::int64_t>(std::round(k)) % 2;
  };
  for (const BrdfSample& sample : training) ASSERT_EQ(parity(sample), 0);
  for (const BrdfSample& sample : held_out) ASSERT_EQ(parity(sample), 1);
}

TEST(Sampling, PhiHIsUniformForAnisotropicBrdfsOnly) {
  for (const auto& s : DrawSamples(kGrey, SampleSet::kTraining, Sampling::kHighlight, 1000, 1)) {
    ASSERT_EQ(s.pair.wi.y + s.pair.wo.y, 0.0);
    ASSERT_GT(s.pair.wi.x + s.pair.wo.x, 0.0);
  }
  constexpr int kBins = 12, kSamples = 60000;
  int bins[kBins] = {};
  for (const auto& s :
       DrawSamples(kBrushed, SampleSet::kTraining, Sampling::kHighlight, kSamples, 1)) {
    ++bins[static_cast<int>(ToAngles(s.pair).phi_h / (2 * kPi) * kBins)];
  }
  const double expected = double(kSamples) / kBins;
  for (int count : bins) EXPECT_NEAR(count, expected, 5.0 * std::sqrt(expected));
}

TEST(Sampling, UniformIsUniformInThetaH) {
  // Of the known angles, those with theta_d < 0.1 are nearly all: 8 equal bins of theta_h below
  // 1.2.
  int bins[8] = {}, total = 0;
  for (const auto& s : DrawSamples(kGrey, SampleSet::kHeldOut, Sampling::kUniform, 200000, 1)) {
    const RusinkiewiczAngles a = ToAngles(s.pair);
    if (a.theta_d >= 0.1 || a.theta_h >= 1.2) continue;
    ++bins[static_cast<int>(a.theta_h / 0.15)];
    ++total;
  }
  for (int count : bins) {
    EXPECT_NEAR(count, total / 8.0, 5.0 * std::sqrt(total / 8.0));
  }
}

TEST(Sampling, HighlightIsDenseNearTheMirrorDirection) {
  const auto below = [](Sampling sampling) {
    int count = 0;
    for (const auto& s : DrawSamples(kGrey, SampleSet::kTraining, sampling, 20000, 1)) {
      count += ToAngles(s.pair).theta_h < 0.01;
    }
    return count;
  };
  EXPECT_GT(below(Sampling::kHighlight), 10 * below(Sampling::kUniform));
}

TEST(Sampling, ValuesAreThoseOfTheBrdf) {
  for (const auto& s : DrawSamples(kGrey, SampleSet::kTraining, Sampling::kUniform, 100, 1)) {
    EXPECT_TRUE(s.pair.AboveHorizon());
    EXPECT_EQ(s.value[0], 0.5 / kPi);
  }
}

TEST(Sampling, SaysSoWhenNothingIsKnown) {
  EXPECT_THAT(
      ErrorOf([] { DrawSamples(UnknownBrdf(), SampleSet::kTraining, Sampling::kUniform, 10, 1); }),
      testing::HasSubstr("too little data: 0 of"));
}

ScatteredBrdf Listed(std::size_t count) {
  ScatteredData data;
  data.kind = "a list";
  for (const DirectionPair& pair : RandomPairs(count, 3)) {
    data.samples.push_back({pair, {0.2, 0.2, 0.2}});
  }
  return ScatteredBrdf(std::move(data));
}

TEST(Sampling, OfFewMeasurementsNoneIsHeldOut) {
  for (const std::size_t count : {20u, 400u}) {
    const ScatteredBrdf list = Listed(count);
    const std::size_t all = list.Measurements().size();
    EXPECT_EQ(HoldsOut(all), count == 400u);
    EXPECT_EQ(TrainingMeasurements(list).size(), HoldsOut(all) ? all - all / 8 : all);
    EXPECT_EQ(HeldOutSamples(list, all, /*seed=*/1).size(), HoldsOut(all) ? all / 8 : all);
  }
  EXPECT_TRUE(TrainingMeasurements(kGrey).empty());
}

TEST(Sampling, WhatIsExpectedFillsTheGaps) {
  // Ten measurements, of what is expected: elsewhere it is taken for that, too.
  const ScatteredBrdf list = Listed(10);
  const auto expected = std::make_shared<LambertBrdf>(Rgb{0.2 * kPi, 0.2 * kPi, 0.2 * kPi});
  std::vector<BrdfSample> samples;
  SampleStream(list, SampleSet::kTraining, Sampling::kHighlight, 1, expected).Draw(20000, &samples);
  EXPECT_EQ(samples.size(), 12000u);
  for (const BrdfSample& sample : samples) EXPECT_NEAR(sample.value[1], 0.2, 1e-9);
}

}  // namespace
}  // namespace pbnbrdf
