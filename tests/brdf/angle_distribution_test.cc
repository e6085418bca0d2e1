#include "pbnbrdf/brdf/angle_distribution.h"

#include <cmath>
#include <random>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

std::array<double, 5> Numbers(std::mt19937_64* random) {
  std::array<double, 5> u;
  for (double& x : u) x = std::uniform_real_distribution<double>(0.0, 1.0)(*random);
  return u;
}

// What is asked for at one pair only comes back from that pair's cell.
TEST(AngleDistribution, DrawsFromTheCellsThatHaveWeight) {
  std::mt19937_64 random(1);
  for (bool isotropic : {true, false}) {
    for (const DirectionPair& pair : RandomPairs(300, 7)) {
      AngleHistogram histogram(isotropic);
      histogram.Add(pair, 0.25);
      const AngleDistribution distribution(histogram);
      const RusinkiewiczAngles asked = ToAngles(pair), drawn = distribution.Draw(Numbers(&random));
      EXPECT_LE(std::abs(std::cbrt(drawn.theta_h) - std::cbrt(asked.theta_h)),
                std::cbrt(0.5 * kPi) / 32 + 1e-12);
      EXPECT_LE(std::abs(drawn.theta_d - asked.theta_d), 0.5 * kPi / 18 + 1e-12);
      EXPECT_LE(std::abs(drawn.phi_d - std::fmod(asked.phi_d, kPi)), kPi / 18 + 1e-12);
      if (isotropic) {
        EXPECT_EQ(drawn.phi_h, 0.0);
      } else {
        EXPECT_LE(std::abs(drawn.phi_h - asked.phi_h), 2 * kPi / 18 + 1e-12);
      }
    }
  }
}

// Cells of theta_h end at (pi/2) (i/32)^3: those of 0.4 and 0.41 are one, that of 1.1 is wider.
TEST(AngleDistribution, DrawsByTheRootOfTheWeights) {
  AngleHistogram histogram(true);
  const auto at = [](double theta_h) { return FromAngles({theta_h, 0.3, 1.0}); };
  histogram.Add(at(0.40), 0.25);
  histogram.Add(at(0.41), 0.75);
  histogram.Add(at(0.6), 0.0);
  histogram.Add(at(1.1), 9.0);
  EXPECT_EQ(histogram.Total(), 10.0);
  const auto width = [](double theta_h) {
    const double i = std::floor(32.0 * std::cbrt(theta_h / (kPi / 2)));
    return std::pow(i + 1.0, 3) - std::pow(i, 3);
  };
  ASSERT_EQ(width(0.40), width(0.41));
  const double expected = 1.0 / (1.0 + std::sqrt(9.0 * width(1.1) / width(0.4)));
  const AngleDistribution distribution(histogram);
  std::mt19937_64 random(2);
  int near = 0, far = 0;
  constexpr int kDraws = 40000;
  for (int k = 0; k < kDraws; ++k) {
    const double theta_h = distribution.Draw(Numbers(&random)).theta_h;
    near += std::abs(theta_h - 0.4) < 0.1;
    far += std::abs(theta_h - 1.1) < 0.15;
  }
  EXPECT_EQ(near + far, kDraws);
  EXPECT_NEAR(near / double(kDraws), expected, 4 * std::sqrt(expected * (1 - expected) / kDraws));
}

TEST(AngleDistribution, ExtremeNumbersStayInCellsWithWeight) {
  AngleHistogram histogram(true);
  histogram.Add(FromAngles({0.4, 0.8, 2.0}), 1e-300);
  const AngleDistribution distribution(histogram);
  const double almost_one = std::nextafter(1.0, 0.0);
  for (double u : {0.0, almost_one}) {
    const RusinkiewiczAngles angles = distribution.Draw({u, u, u, u, u});
    EXPECT_NEAR(angles.theta_h, 0.4, 0.2);
    EXPECT_NEAR(angles.theta_d, 0.8, 0.09);
  }
}

TEST(AngleDistribution, RefusesToDrawFromNothing) {
  EXPECT_EQ(ErrorOf([] { AngleDistribution(AngleHistogram(true)); }),
            "a distribution of angles whose weights are all 0");
}

// Samples of a fit: 1 - floor from the cell that is asked for, the rest as ever.
TEST(AngleDistribution, SamplesKeepAFloor) {
  class Grey final : public PointwiseBrdf {
   public:
    std::string Description() const override { return "grey"; }

   protected:
    Rgb Value(const DirectionPair&) const override { return {0.1, 0.1, 0.1}; }
  };
  AngleHistogram histogram(true);
  histogram.Add(FromAngles({0.7, 0.2, 0.5}), 1.0);
  SampleAngles angles = Sampling::kUniform;
  angles.asked = std::make_shared<const AngleDistribution>(histogram);
  angles.floor = 0.3;
  constexpr std::size_t kSamples = 20000;
  const auto samples = DrawSamples(Grey(), SampleSet::kTraining, angles, kSamples, 3);
  std::size_t asked = 0;
  for (const BrdfSample& sample : samples) {
    const RusinkiewiczAngles a = ToAngles(sample.pair);
    // A cell's extent about what was added.
    asked += std::abs(a.theta_h - 0.7) < 0.15 && std::abs(a.theta_d - 0.2) < 0.09 &&
             std::abs(a.phi_d - 0.5) < 0.18;
  }
  // Uniform angles are hardly ever in that cell, and known more rarely elsewhere than there.
  EXPECT_GT(asked, 0.7 * kSamples);
  EXPECT_LT(asked, 0.9 * kSamples);
}

}  // namespace
}  // namespace pbnbrdf
