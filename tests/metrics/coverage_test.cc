#include "pbnbrdf/metrics/coverage.h"

#include <bit>
#include <random>

#include "base/uniform.h"
#include "pbnbrdf/brdf/scattered.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

// 0.2, and known where theta_i is below an angle only; with noise that differs from direction to direction.
class GreyBrdf final : public Brdf {
 public:
  explicit GreyBrdf(double least_cos_i, double noise = 0.0)
      : least_cos_i_(least_cos_i), noise_(noise) {}
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      std::mt19937_64 random(std::bit_cast<std::uint64_t>(pairs[n].wo.x));
      for (double& channel : values[n]) channel = 0.2 + noise_ * Normal(random);
    }
  }
  bool IsKnown(const DirectionPair& pair) const override { return pair.wi.z > least_cos_i_; }
  std::string Description() const override { return "grey"; }

  static double Normal(std::mt19937_64& random) {
    return std::sqrt(-2.0 * std::log(1.0 - Uniform(random))) *
           std::cos(2.0 * kPi * Uniform(random));
  }

 private:
  double least_cos_i_, noise_;
};

TEST(Coverage, IsThePartOfSolidAngles) {
  EXPECT_EQ(MeasureCoverage(GreyBrdf(0.0)).known, 1.0);
  EXPECT_EQ(MeasureCoverage(GreyBrdf(1.0)).known, 0.0);
  EXPECT_NEAR(MeasureCoverage(GreyBrdf(0.5)).known, 0.5, 0.01);
  EXPECT_FALSE(MeasureCoverage(GreyBrdf(0.5)).in_plane);
}

TEST(Coverage, KnowsScansInAPlane) {
  ScatteredData data;
  const auto add = [&](double theta_i, double phi_i, double theta_o, double phi_o) {
    data.samples.push_back({{FromSpherical(theta_i, phi_i), FromSpherical(theta_o, phi_o)}, {}});
  };
  add(0.3, 0.0, 0.5, kPi);
  add(0.3, kPi, 0.5, kPi + 1e-6);
  add(0.3, 0.2, 0.5, kPi + 0.2);  // the sample turned
  add(0.0, 0.0, 0.5, 1.0);
  EXPECT_TRUE(MeasureCoverage(ScatteredBrdf(data)).in_plane);
  add(0.3, 0.0, 0.5, kPi + 0.01);
  EXPECT_FALSE(MeasureCoverage(ScatteredBrdf(data)).in_plane);
}

TEST(Coverage, NoiseShowsInTables) {
  EXPECT_EQ(MeasureCoverage(GreyBrdf(0.0)).noise, 0.0);
  EXPECT_NEAR(MeasureCoverage(GreyBrdf(0.0, 0.01)).noise, 0.01, 0.001);
  EXPECT_EQ(MeasureCoverage(GreyBrdf(0.0, 0.01)).negative, 0.0);
  // One of three channels below 0 where a normally distributed number is below -1.
  const double below = 1.0 - std::pow(1.0 - 0.1587, 3);
  EXPECT_NEAR(MeasureCoverage(GreyBrdf(0.0, 0.2)).negative, below, 0.02);
}

TEST(Coverage, NoiseShowsInLists) {
  std::mt19937_64 random(1);
  ScatteredData data;
  for (int n = 0; n < 3000; ++n) {
    const double theta_i = 1.4 * Uniform(random), theta_o = 1.4 * Uniform(random);
    const DirectionPair pair = {FromSpherical(theta_i, 0.0),
                                FromSpherical(theta_o, 2.0 * kPi * Uniform(random))};
    Rgb value;
    for (double& channel : value) channel = 0.05 + 0.05 * GreyBrdf::Normal(random);
    data.samples.push_back({pair, value});
  }
  const Coverage coverage = MeasureCoverage(ScatteredBrdf(data));
  EXPECT_NEAR(coverage.noise, 0.05, 0.005);
  EXPECT_NEAR(coverage.negative, 1.0 - std::pow(1.0 - 0.1587, 3), 0.03);
}

}  // namespace
}  // namespace pbnbrdf
