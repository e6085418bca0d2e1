// The minibatch gradient against central differences of the loss it is the gradient of.
#include "pbnbrdf/problem/minibatch_gradient.h"

#include "network/random_network.h"
#include "pbnbrdf/brdf/builtin.h"
#include "pbnbrdf/network/mlp.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "pbnbrdf/residuals/log_residual.h"

namespace pbnbrdf {
namespace {

double PaperLoss(const FitProblem& problem, std::span<const BrdfSample> samples,
                 const std::vector<double>& weights) {
  const NetworkShape shape = problem.Shape();
  const auto blocks = shape.Blocks<const double>(weights.data());
  double sum = 0.0;
  for (const BrdfSample& s : samples) {
    double z[3], log[3], chroma;
    EvaluateMlp(shape, Encode(shape.encoding(), s.pair).data(), blocks.data(), z);
    for (double& value : z) value = std::max(value, 0.0);
    LogResidual(s.value, CosI(s.pair))(z, log);
    ChromaticityResidual(s.value, CosI(s.pair))(z, &chroma);
    sum += problem.log_weight * (std::abs(log[0]) + std::abs(log[1]) + std::abs(log[2])) / 3.0 +
           problem.chromaticity_weight * std::abs(chroma);
  }
  return sum / static_cast<double>(samples.size());
}

class MinibatchGradientTest : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(MinibatchGradientTest, IsThatOfThePapersLoss) {
  FitProblem problem;
  problem.hidden = {5, 4};
  std::tie(problem.log_weight, problem.chromaticity_weight) = GetParam();
  const NetworkShape shape = problem.Shape();
  const auto samples = DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining,
                                   Sampling::kUniform, 300, /*seed=*/1);
  std::vector<double> weights = RandomWeights(shape, 0.8, /*seed=*/2);
  std::vector<std::uint32_t> indices(200);  // a full block and a part of one, out of order
  std::vector<BrdfSample> minibatch;
  for (std::size_t n = 0; n < indices.size(); ++n) {
    indices[n] = static_cast<std::uint32_t>((7 * n) % samples.size());
    minibatch.push_back(samples[indices[n]]);
  }
  MinibatchGradient objective(problem, samples);
  EXPECT_EQ(objective.num_samples(), 300u);
  std::vector<float> gradient(weights.size());
  const std::vector<float> single(weights.begin(), weights.end());
  objective.Evaluate(single.data(), indices, gradient.data());
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double at = weights[i];
    weights[i] = at + kStep;
    const double above = PaperLoss(problem, minibatch, weights);
    weights[i] = at - kStep;
    const double below = PaperLoss(problem, minibatch, weights);
    weights[i] = at;
    EXPECT_NEAR(gradient[i], (above - below) / (2 * kStep), 2e-4) << "weight " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Terms, MinibatchGradientTest,
                         testing::Values(std::tuple(1.0, 0.0), std::tuple(0.0, 1.0),
                                         std::tuple(1.0, 0.5)));

}  // namespace
}  // namespace pbnbrdf
