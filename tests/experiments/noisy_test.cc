#include "noisy.h"

#include <cmath>

#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/problem/sampling.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

const LambertBrdf kDiffuse({0.9, 0.6, 0.3});

struct Moments {
  double mean, deviation;
};

Moments MomentsOf(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v, squares += v * v;
  const double mean = sum / double(values.size());
  return {mean, std::sqrt(squares / double(values.size()) - mean * mean)};
}

TEST(Noisy, MeasurementsHaveTheNoiseAskedFor) {
  const double f = 0.6 / kPi;
  for (const Noise& noise : {Noise{}, Noise{.additive = 0.1}, Noise{.multiplicative = 0.2}}) {
    std::vector<double> values;
    for (const BrdfSample& s : NoisyMeasurements(kDiffuse, 20000, noise, 3).Measurements()) {
      values.push_back(s.value[1]);
      EXPECT_GT(s.pair.wi.z, std::cos(80.1 * kPi / 180.0));
    }
    const auto [mean, deviation] = MomentsOf(values);
    EXPECT_NEAR(mean, f, 0.003);
    EXPECT_NEAR(deviation, noise.additive + noise.multiplicative * f, 0.003);
  }
}

TEST(Noisy, TablesKeepNegativeValues) {
  const MerlBrdf clean = MerlBrdf::Tabulate(kDiffuse);
  const MerlBrdf noisy = NoisyTable(kDiffuse, {.additive = 0.1}, 1);
  EXPECT_EQ(noisy.valid_bins(), clean.valid_bins());
  std::vector<double> values;
  std::size_t negative = 0;
  for (std::size_t bin = 0; bin < MerlBrdf::kBins; ++bin) {
    if (clean.Stored(0, bin) < 0.0) continue;
    values.push_back(noisy.Stored(2, bin) * 1.66 / 1500.0);
    negative += values.back() < 0.0;
  }
  const auto [mean, deviation] = MomentsOf(values);
  EXPECT_NEAR(mean, 0.3 / kPi, 0.001);
  EXPECT_NEAR(deviation, 0.1, 0.001);
  EXPECT_GT(negative, values.size() / 10);
}

TEST(Noisy, DarkHalfBiasIsThatOfTheWorstChannel) {
  const GgxBrdf glossy({0.1, 0.1, 0.1}, 0.3, {0.2, 0.3, 0.4});
  const auto samples = HeldOutSamples(glossy, 2000, 1);
  EXPECT_EQ(DarkHalfBias(samples, glossy), 0.0);
  const ScaledBrdf brighter(std::make_unique<GgxBrdf>(glossy), 1.25);
  EXPECT_NEAR(DarkHalfBias(samples, brighter), 0.25, 1e-9);
  const LambertBrdf reference({0.9, 0.6, 0.3}), off({0.9, 0.66, 0.24});
  EXPECT_NEAR(DarkHalfBias(HeldOutSamples(reference, 2000, 1), off), -0.2, 1e-9);
}

}  // namespace
}  // namespace pbnbrdf
