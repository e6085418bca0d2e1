#include "pbnbrdf/brdf/scattered.h"

#include <set>

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// A model, measured at random directions.
ScatteredBrdf Measured(const Brdf& model, std::size_t count, unsigned seed) {
  ScatteredData data;
  data.kind = "test";
  data.isotropic = model.IsIsotropic();
  for (const DirectionPair& pair : RandomPairs(count, seed)) {
    data.samples.push_back({pair, ValueAt(model, pair)});
  }
  return ScatteredBrdf(std::move(data));
}

const WardBrdf kGlossy({0.2, 0.1, 0.05}, {0.1, 0.2, 0.3}, 0.3);
const WardBrdf kBrushed({0.2, 0.1, 0.05}, {0.1, 0.2, 0.3}, {0.3, 0.6});

TEST(Scattered, MeasurementsComeBackAsTheyAre) {
  for (const Brdf* model :
       {static_cast<const Brdf*>(&kGlossy), static_cast<const Brdf*>(&kBrushed)}) {
    const ScatteredBrdf brdf = Measured(*model, 3000, 1);
    for (const BrdfSample& sample : brdf.Measurements()) {
      ASSERT_EQ(ValueAt(brdf, sample.pair), sample.value);
      ASSERT_EQ(ValueAt(brdf, Swapped(sample.pair)), sample.value);
      ASSERT_TRUE(brdf.IsKnown(sample.pair));
    }
  }
}

TEST(Scattered, WhatWasMeasuredTwiceIsTheMean) {
  const DirectionPair pair = {FromSpherical(0.3, 0.0), FromSpherical(0.6, 2.0)};
  ScatteredData data;
  data.samples = {
      {pair, {1, 2, 3}}, {Swapped(pair), {3, 4, 5}}, {{{0, 0, 1}, {0, 0, 1}}, {9, 9, 9}}};
  EXPECT_EQ(ValueAt(ScatteredBrdf(data), pair), (Rgb{2, 3, 4}));
}

// f in between, of a smooth material, and how that gets better with more measurements.
TEST(Scattered, InterpolatesInBetween) {
  for (const Brdf* model :
       {static_cast<const Brdf*>(&kGlossy), static_cast<const Brdf*>(&kBrushed)}) {
    const auto mean_error = [&](std::size_t measurements) {
      const ScatteredBrdf brdf = Measured(*model, measurements, 1);
      double sum = 0.0;
      const std::vector<DirectionPair> pairs = RandomPairs(2000, 2);
      for (const DirectionPair& pair : pairs) {
        const double cos_i = pair.wi.z;
        sum += std::abs(std::log1p(ValueAt(brdf, pair)[1] * cos_i) -
                        std::log1p(ValueAt(*model, pair)[1] * cos_i));
      }
      return sum / double(pairs.size());
    };
    const double few = mean_error(1000), many = mean_error(30000);
    EXPECT_LT(few, 0.02);
    EXPECT_LT(many, 0.5 * few);
  }
}

TEST(Scattered, AConstantStaysOne) {
  const ScatteredBrdf brdf = Measured(LambertBrdf({0.9, 0.5, 0.1}), 50, 1);
  for (const DirectionPair& pair : HardAndRandomPairs(1000, 3)) {
    if (!pair.AboveHorizon()) continue;
    ASSERT_NEAR(ValueAt(brdf, pair)[0], 0.9 / kPi, 1e-12);
  }
}

TEST(Scattered, IsReciprocalAndTurnsIfIsotropic) {
  const ScatteredBrdf isotropic = Measured(kGlossy, 1000, 1), other = Measured(kBrushed, 1000, 1);
  double most = 0.0;
  for (const DirectionPair& pair : HardAndRandomPairs(500, 4)) {
    if (!pair.AboveHorizon()) continue;
    ASSERT_EQ(ValueAt(other, pair), ValueAt(other, Swapped(pair)));
    ASSERT_EQ(ValueAt(isotropic, pair), ValueAt(isotropic, Swapped(pair)));
    // sqrt(theta_h) makes much of rounding at the mirror direction.
    ASSERT_NEAR(ValueAt(isotropic, pair)[0], ValueAt(isotropic, Turned(pair, 1.0))[0], 1e-6);
    most = std::max(most, std::abs(ValueAt(other, pair)[0] - ValueAt(other, Turned(pair, 1.0))[0]));
  }
  EXPECT_GT(most, 0.01);
}

DirectionPair Mirrored(const DirectionPair& pair) {
  const auto image = [](const Vec3& w) { return Vec3{w.x, -w.y, w.z}; };
  return {image(pair.wi), image(pair.wo)};
}

TEST(Scattered, WhatWasMeasuredOnOneSideStandsForTheOther) {
  ScatteredData one_side, both;
  for (const DirectionPair& pair : RandomPairs(500, 5)) {
    if (std::sin(2.0 * ToAngles(pair).phi_d) < 0.0) continue;
    one_side.samples.push_back({pair, ValueAt(kGlossy, pair)});
    both.samples.push_back(one_side.samples.back());
    both.samples.push_back({Mirrored(pair), {7, 8, 9}});
  }
  const ScatteredBrdf sided(one_side), full(both);
  int mirrored = 0;
  for (const BrdfSample& sample : sided.Measurements()) {
    EXPECT_EQ(ValueAt(sided, sample.pair), sample.value);
    EXPECT_EQ(ValueAt(full, sample.pair), sample.value);
    EXPECT_EQ(ValueAt(full, Mirrored(sample.pair)), (Rgb{7, 8, 9}));
    mirrored += ValueAt(sided, Mirrored(sample.pair)) == sample.value;
  }
  EXPECT_GT(mirrored, 150);  // but next to the plane of symmetry, where others are near
}

TEST(Scattered, IsKnownNearMeasurementsOnly) {
  ScatteredData data;
  for (double theta : {0.1, 0.2}) {  // theta_h = 0 all
    data.samples.push_back({{FromSpherical(theta, 0), FromSpherical(theta, kPi)}, {1, 1, 1}});
  }
  const ScatteredBrdf brdf(data);
  const auto known = [&](double theta_h, double theta_d) {
    return brdf.IsKnown(FromAngles({.theta_h = theta_h, .theta_d = theta_d}));
  };
  const double reach = ScatteredBrdf::kReach;
  EXPECT_TRUE(known(0.0, 0.2 + 0.99 * reach * kPi / 2));
  EXPECT_FALSE(known(0.0, 0.2 + 1.01 * reach * kPi / 2));
  EXPECT_TRUE(known(0.9 * reach * reach * kPi / 2, 0.2));
  EXPECT_FALSE(known(1.01 * reach * reach * kPi / 2, 0.2));
}

TEST(Scattered, WhatCannotBeUsedIsLeftOutAndCounted) {
  const Vec3 up = {0, 0, 1}, level = {1, 0, 0}, down = {0.6, 0, -0.8};
  ScatteredData data;
  data.kind = "test";
  data.left_out = 2;
  data.samples = {
      {{up, up}, {1, 1, 1}},       {{up, level}, {1, 1, 1}},         {{down, up}, {1, 1, 1}},
      {{up, up}, {1, -0.9991, 1}}, {{up, up}, {1, std::nan(""), 1}}, {{up, up}, {1e300, 0, 0}}};
  const ScatteredBrdf brdf(data);
  EXPECT_THAT(brdf.Description(), HasSubstr("RGB, 2 measurements, 6 unusable ones left out"));
  EXPECT_EQ(ValueAt(brdf, {up, up})[0], 0.5 * (1.0 + Brdf::kLargestValue));
  data.samples = {{{up, level}, {1, 1, 1}}};
  EXPECT_THAT(ErrorOf([&] { ScatteredBrdf{data}; }),
              HasSubstr("no data: of 3 measurements none has"));
}

using Key = std::array<double, 4>;
std::multiset<Key> Keys(const std::vector<BrdfSample>& samples) {
  std::multiset<Key> keys;
  for (const BrdfSample& s : samples)
    keys.insert({s.pair.wi.x, s.pair.wi.y, s.pair.wo.x, s.value[0]});
  return keys;
}

std::vector<BrdfSample> Draw(const Brdf& brdf, SampleSet set, std::uint64_t seed) {
  return DrawSamples(brdf, set, Sampling::kHighlight, 100000, seed);
}

// Towards 12 directions from each of the angles, and once from another.
ScatteredData MeasuredAtAngles(const std::vector<double>& angles) {
  ScatteredData data;
  for (double theta_i : angles) {
    for (int k = 0; k < 12; ++k) {
      const double rounding = 1e-4 * (k % 3);
      data.samples.push_back(
          {{FromSpherical(theta_i + rounding, 0.0), FromSpherical(0.1 * k, 1.0)}, {1, 2, 3}});
    }
  }
  data.samples.push_back({{FromSpherical(1.2, 0.0), FromSpherical(angles[1], 2.0)}, {1, 2, 3}});
  return data;
}

TEST(Scattered, IncidentAnglesAreThoseOfManyMeasurements) {
  const ScatteredBrdf brdf(MeasuredAtAngles({0.8, 0.2, 0.5}));
  const std::vector<double> angles = brdf.IncidentAngles();
  ASSERT_EQ(angles.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(angles[k], 0.2 + 0.3 * double(k), 2e-4);
  EXPECT_TRUE(Measured(kGlossy, 100, 1).IncidentAngles().empty());
}

TEST(Scattered, AnIncidentAngleCanBeLeftOut) {
  const ScatteredBrdf brdf(MeasuredAtAngles({0.2, 0.5, 0.8}));
  const std::unique_ptr<Brdf> rest = brdf.WithoutIncidentAngle(1);
  EXPECT_EQ(rest->IncidentAngles().size(), 2u);
  EXPECT_EQ(rest->Measurements().size(), brdf.Measurements().size() - 12);
  std::size_t towards = 0;
  for (const BrdfSample& sample : rest->Measurements()) {
    EXPECT_GT(std::abs(std::acos(sample.pair.wi.z) - 0.5), 0.1);
    towards += std::abs(std::acos(sample.pair.wo.z) - 0.5) < 1e-9;
  }
  EXPECT_EQ(towards, 3u) << "the other order stays";
}

TEST(ScatteredSampling, EverySampleIsDrawnOnceFromOneOfTheSets) {
  const ScatteredBrdf brdf = Measured(kGlossy, 4000, 1);
  const std::size_t count = brdf.Measurements().size();
  const auto training = Draw(brdf, SampleSet::kTraining, 1);
  const auto held_out = Draw(brdf, SampleSet::kHeldOut, 1);
  EXPECT_EQ(held_out.size(), count / 8);
  const std::size_t measured = count - held_out.size();
  EXPECT_EQ(training.size(), measured + measured / 3);
  std::multiset<Key> all = Keys(training);
  all.merge(Keys(held_out));
  for (const Key& key : Keys(brdf.Measurements())) EXPECT_EQ(all.count(key), 1u);
  // The same sets for any seed, in another order.
  const auto other = Draw(brdf, SampleSet::kHeldOut, 2);
  EXPECT_EQ(Keys(other), Keys(held_out));
  EXPECT_NE(other[0].pair.wi.x, held_out[0].pair.wi.x);
}

TEST(ScatteredSampling, AStreamGoesOnWhereItStopped) {
  const ScatteredBrdf brdf = Measured(kGlossy, 100, 1);
  const auto all = Draw(brdf, SampleSet::kTraining, 3);
  SampleStream stream(brdf, SampleSet::kTraining, Sampling::kHighlight, 3);
  EXPECT_EQ(stream.most(), all.size());
  std::vector<BrdfSample> samples;
  for (std::size_t count : {1, 0, 500, 3000, 10000, 5}) stream.Draw(count, &samples);
  ASSERT_EQ(samples.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    ASSERT_EQ(samples[n].value, all[n].value);
    ASSERT_EQ(samples[n].pair.wo.x, all[n].pair.wo.x);
  }
}

TEST(ScatteredSampling, FewMeasurementsAreRepeatedAlike) {
  const ScatteredBrdf brdf = Measured(kGlossy, 1000, 1);
  const std::multiset<Key> training = Keys(Draw(brdf, SampleSet::kTraining, 1));
  std::size_t measured = 0;
  for (const Key& key : Keys(brdf.Measurements())) {
    EXPECT_TRUE(training.count(key) == 0 || training.count(key) == 4) << training.count(key);
    measured += training.count(key);
  }
  EXPECT_GE(measured, 3000u);
  EXPECT_EQ(training.size(), measured + measured / 3);
}

// What is interpolated comes from the training samples, however much others stand out.
TEST(ScatteredSampling, HeldOutValuesDontLeak) {
  std::multiset<Key> held_out;
  ScatteredData data;
  data.samples = Measured(LambertBrdf({0.3, 0.3, 0.3}), 1000, 1).Measurements();
  for (const auto& s : Draw(ScatteredBrdf(data), SampleSet::kHeldOut, 1)) {
    held_out.insert({s.pair.wi.x, s.pair.wi.y, s.pair.wo.x, 0.0});
  }
  for (BrdfSample& s : data.samples) {
    if (held_out.count({s.pair.wi.x, s.pair.wi.y, s.pair.wo.x, 0.0}) > 0) s.value = {1e6, 1e6, 1e6};
  }
  for (const auto& s : Draw(ScatteredBrdf(data), SampleSet::kTraining, 2)) {
    ASSERT_NEAR(s.value[0], 0.3 / kPi, 1e-4);  // in gaps by a model that is fitted
  }
}

// Twins of a held-out measurement would tell its value.
TEST(ScatteredSampling, MeasurementsAtOnePlaceAreInOneSet) {
  ScatteredData data;
  for (const DirectionPair& pair : RandomPairs(400, 1)) {
    const Rgb value = {pair.wi.z, pair.wo.z, 0.5};
    data.samples.push_back({pair, value});
    data.samples.push_back({Swapped(pair), value});
    data.samples.push_back({Turned(pair, 0.7), value});
    data.samples.push_back(
        {{{pair.wi.x, -pair.wi.y, pair.wi.z}, {pair.wo.x, -pair.wo.y, pair.wo.z}}, value});
  }
  const ScatteredBrdf brdf(data);
  std::multiset<double> training;
  for (const auto& s : DrawSamples(brdf, SampleSet::kTraining, Sampling::kUniform, 9999, 1)) {
    training.insert(s.value[0]);
  }
  for (const auto& s : DrawSamples(brdf, SampleSet::kHeldOut, Sampling::kUniform, 9999, 1)) {
    EXPECT_EQ(training.count(s.value[0]), 0u);
  }
}

TEST(ScatteredSampling, TwoMeasurementsAreEnough) {
  ScatteredData data;
  data.samples = {{{{0, 0, 1}, {0, 0, 1}}, {1, 1, 1}}, {{{0, 0, 1}, {0.6, 0, 0.8}}, {2, 2, 2}}};
  EXPECT_EQ(Draw(ScatteredBrdf(data), SampleSet::kHeldOut, 1).size(), 2u);
  EXPECT_EQ(Draw(ScatteredBrdf(data), SampleSet::kTraining, 1).size(), 4000u);
  data.samples.pop_back();
  EXPECT_THAT(ErrorOf([&] { Draw(ScatteredBrdf(data), SampleSet::kTraining, 1); }),
              HasSubstr("too little data: a single measurement"));
}

TEST(ScatteredSampling, ScaledMeasurementsAreScaled) {
  const auto source = [] { return std::make_unique<ScatteredBrdf>(Measured(kGlossy, 100, 1)); };
  const ScaledBrdf scaled(source(), 0.5);
  const auto half = Draw(scaled, SampleSet::kTraining, 1);
  const auto full = Draw(*source(), SampleSet::kTraining, 1);
  ASSERT_EQ(half.size(), full.size());
  for (std::size_t n = 0; n < half.size(); ++n) {
    const double expected = 0.5 * full[n].value[1];
    if (full[n].weight == 1.0) {
      ASSERT_EQ(half[n].value[1], expected);
    } else {  // between measurements, by a model that is fitted
      ASSERT_NEAR(half[n].value[1], expected, 0.01 + 0.2 * expected);
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
