// Fits of noisy measurements.
#include <cstring>
#include <random>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {
namespace {

// A dark grey material, with noise much larger than its values: the same at the same pair.
class NoisyBrdf final : public Brdf {
 public:
  static constexpr double kValue = 0.003, kDeviation = 0.01;

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      std::uint64_t seed;
      std::memcpy(&seed, &pairs[n].wo.x, sizeof(seed));
      std::mt19937_64 random(seed);
      std::normal_distribution<double> noise(kValue, kDeviation);
      for (double& value : values[n]) value = noise(random);
    }
  }
  bool IsReciprocal() const override { return true; }
  std::string Description() const override { return "noise"; }
};

TEST(Noise, LeavesNoBiasInTheDark) {
  FitProblem problem;
  problem.network.hidden = {5};
  problem.sampling.samples = 20000;
  FitOptions options;
  options.schedule.max_iterations = 60;
  const Fit fit = FitBrdf(NoisyBrdf(), problem, options);
  std::vector<DirectionPair> pairs;
  for (const DirectionPair& pair : RandomPairs(2000, 5)) {
    if (std::min(pair.wi.z, pair.wo.z) > 0.1) pairs.push_back(pair);
  }
  std::vector<Rgb> values(pairs.size());
  fit.network.Evaluate(pairs, values);
  double sum = 0.0;
  for (const Rgb& value : values) sum += value[0] + value[1] + value[2];
  EXPECT_NEAR(sum / static_cast<double>(3 * values.size()), NoisyBrdf::kValue,
              0.3 * NoisyBrdf::kValue);
}

}  // namespace
}  // namespace pbnbrdf
