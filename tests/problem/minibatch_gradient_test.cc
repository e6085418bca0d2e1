// The minibatch gradient against that of Objective with Loss::kAbsolute, and the energy term's
// against central differences.
#include "problem/minibatch_gradient.h"

#include <numbers>

#include "network/random_network.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/mlp.h"
#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {
namespace {

constexpr int kBatch = kernels::kBatch;

FitProblem SmallProblem(double log_weight, double chromaticity_weight) {
  FitProblem problem;
  problem.network.hidden = {5, 4};
  problem.sampling.samples = 200;  // a full block and a part of one
  problem.terms.SetWeight("log", log_weight);
  problem.terms.SetWeight("chromaticity", chromaticity_weight);
  problem.terms.SetWeight("energy", 0.0);
  problem.terms.loss = Loss::kAbsolute;
  return problem;
}

std::vector<BrdfSample> Samples(const FitProblem& problem) {
  std::vector<BrdfSample> samples =
      DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining, Sampling::kUniform,
                  problem.sampling.samples, /*seed=*/1);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n].weight = 1.0 / (1.0 + static_cast<double>(n % 3));
  }
  return samples;
}

std::vector<float> Gradient(const FitProblem& problem, const Minibatches& minibatches,
                            std::size_t minibatch, const std::vector<double>& weights) {
  const std::vector<float> single(weights.begin(), weights.end());
  std::vector<float> gradient(weights.size());
  MinibatchGradient(problem).Evaluate(single.data(), minibatches, minibatch, gradient.data());
  return gradient;
}

class MinibatchGradientTest
    : public testing::TestWithParam<std::tuple<double, double, Activation>> {};

TEST_P(MinibatchGradientTest, IsThatOfTheObjective) {
  const auto [log_weight, chromaticity_weight, activation] = GetParam();
  FitProblem problem = SmallProblem(log_weight, chromaticity_weight);
  problem.network.activation = activation;
  const auto samples = Samples(problem);
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/2);
  const EncodedSamples encoded(problem.Shape().encoding(), samples);
  MinibatchStream stream(problem, encoded, samples.size(), /*energy_angles=*/1);
  Minibatches run;
  stream.Draw(&run);
  const std::vector<float> gradient = Gradient(problem, run, 0, weights);
  double cost;
  std::vector<double> expected(weights.size());
  ASSERT_TRUE(MakeObjective(problem, Precision::kDouble, samples)
                  ->Gradient(weights.data(), &cost, expected.data()));
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(gradient[i], expected[i], 2e-5) << "weight " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Terms, MinibatchGradientTest,
                         testing::Values(std::tuple(1.0, 0.0, Activation::kTanh),
                                         std::tuple(0.0, 1.0, Activation::kTanh),
                                         std::tuple(1.0, 0.5, Activation::kRelu)));

// 2 pi times the mean over the minibatch's albedos and channels of max(0, albedo - 1).
double EnergyLoss(const FitProblem& problem, std::span<const Minibatches::Albedo> albedos,
                  const Minibatches& run, const std::vector<double>& weights) {
  const NetworkShape shape = problem.Shape();
  const auto blocks = shape.Blocks<const double>(weights.data());
  double loss = 0.0;
  for (const Minibatches::Albedo& albedo : albedos) {
    double sum[3] = {};
    for (std::size_t n = 0; n < albedo.blocks * kBatch; ++n) {
      const float* node = run.NodeBlock(albedo.first_block + n / kBatch) + n % kBatch;
      double input[kEncodedSize], z[3];
      for (int i = 0; i < kEncodedSize; ++i) input[i] = node[i * kBatch];
      EvaluateMlp(shape, input, blocks.data(), z);
      for (int c = 0; c < 3; ++c) {
        sum[c] += node[Minibatches::kWeight * kBatch] * std::expm1(std::max(0.0, z[c]));
      }
    }
    for (double value : sum) loss += std::max(0.0, value - 1.0);
  }
  return 2.0 * std::numbers::pi * loss / (3.0 * static_cast<double>(albedos.size()));
}

TEST(MinibatchGradient, EnergyTermIsThatOfEquation5) {
  FitProblem problem = SmallProblem(1.0, 0.0);
  problem.terms.energy_theta = 16;
  problem.terms.energy_phi = 12;
  const EncodedSamples samples(problem.Shape().encoding(), Samples(problem));
  MinibatchStream without(problem, samples, /*batch=*/50, /*energy_angles=*/3);
  problem.terms.SetWeight("energy", 2.0);
  MinibatchStream with(problem, samples, /*batch=*/50, /*energy_angles=*/3);
  Minibatches run_without, run;
  without.Draw(&run_without);
  with.Draw(&run);
  ASSERT_EQ(run.samples, run_without.samples);
  std::vector<double> weights = RandomWeights(problem.Shape(), 0.3, /*seed=*/2);
  // Red is brighter than white, green about as bright, blue below.
  for (auto [channel, bias] : {std::pair(0, 0.5), {1, 0.28}, {2, 0.05}}) {
    weights[problem.Shape().offset(2) + 5 * channel + 4] = bias;
  }
  const auto all = Gradient(problem, run, 1, weights);
  problem.terms.SetWeight("energy", 0.0);
  const auto rest = Gradient(problem, run_without, 1, weights);
  double largest = 0.0;
  constexpr double kStep = 1e-6;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto loss_at = [&](double step) {
      std::vector<double> moved = weights;
      moved[i] += step;
      return 2.0 * EnergyLoss(problem, run.AlbedosOf(1), run, moved);
    };
    const double expected = (loss_at(kStep) - loss_at(-kStep)) / (2 * kStep);
    EXPECT_NEAR(all[i] - rest[i], expected, 1e-4 * (1.0 + std::abs(expected))) << "weight " << i;
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 1.0);
}

}  // namespace
}  // namespace pbnbrdf
