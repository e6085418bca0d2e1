#include "solve/start.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "problem/initial_weights.h"

namespace pbnbrdf {
namespace {

constexpr int kMaxRestarts = 5;
constexpr std::uint64_t kIndexSeed = 0xbf58476d1ce4e5b9, kRestartSeed = 0x94d049bb133111eb;
constexpr double kRoundingSpread = 1e-6;

enum class StartQuality {
  kGood,
  kConstant,  // the material isn't constant, but the network is and stays so, since no weight of its
              // first layer has a gradient, as with a layer of dead units
  kStuck,     // no weight at all has a gradient, and the cost isn't 0
  kNotFinite,  // the cost or its gradient isn't finite
};

// By more than rounding makes of a constant.
bool Varies(const std::vector<Rgb>& values) {
  return std::any_of(values.begin(), values.end(), [&](const Rgb& value) {
    for (int c = 0; c < NetworkShape::kChannels; ++c) {
      const double first = values.front()[c];
      if (std::abs(value[c] - first) > kRoundingSpread * (1.0 + first)) return true;
    }
    return false;
  });
}

StartQuality Judge(Objective* objective, const EncodedSamples& all_samples,
                   const std::vector<double>& weights) {
  const auto samples = all_samples.first(kStartSamples);
  const NetworkShape& shape = objective->shape();
  double cost = 0.0;
  std::vector<double> gradient(shape.num_weights());
  if (!objective->Gradient(weights.data(), &cost, gradient.data())) {
    return StartQuality::kNotFinite;
  }
  const auto rest = gradient.begin() + shape.block_size(0);
  const auto is_zero = [](double slope) { return slope == 0.0; };
  if (cost == 0.0 || !std::all_of(gradient.begin(), rest, is_zero)) return StartQuality::kGood;
  if (std::all_of(rest, gradient.end(), is_zero)) return StartQuality::kStuck;
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> wanted, values(samples.size());
  for (const BrdfSample& sample : samples) {
    pairs.push_back(sample.pair);
    wanted.push_back(sample.value);
  }
  NeuralBrdf(shape, weights).EvaluateUnclipped(pairs, values);
  return Varies(wanted) && !Varies(values) ? StartQuality::kConstant : StartQuality::kGood;
}

}  // namespace

void CheckStart(Objective* objective, const EncodedSamples& samples,
                const std::vector<double>& weights) {
  const StartQuality quality = Judge(objective, samples, weights);
  if (quality == StartQuality::kNotFinite) {
    Fail("initial_weights: the cost or its gradient isn't finite there");
  }
  if (quality == StartQuality::kStuck) {
    Fail("initial_weights: the gradient is 0 there and the cost isn't");
  }
  if (quality == StartQuality::kConstant) {
    Fail("initial_weights: a constant network that stays one: its first layer has no gradient");
  }
}

RandomStart DrawStart(const FitProblem& problem, Objective* objective,
                      const EncodedSamples& samples, int index) {
  RandomStart start;
  std::vector<double> constant;
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    const std::uint64_t seed = problem.sampling.seed +
                               static_cast<std::uint64_t>(index) * kIndexSeed +
                               static_cast<std::uint64_t>(restart) * kRestartSeed;
    start.weights =
        InitialWeights(problem.Shape(), samples.samples(), seed, problem.network.initialization);
    const StartQuality quality = Judge(objective, samples, start.weights);
    if (quality == StartQuality::kGood) return start;
    if (quality == StartQuality::kConstant && constant.empty()) constant = start.weights;
    if (restart < kMaxRestarts) ++start.restarts;
  }
  if (constant.empty()) {
    Fail("no start: at each of ", kMaxRestarts + 1,
         " random ones the cost isn't finite or its gradient is 0");
  }
  start.weights = constant;
  return start;
}

}  // namespace pbnbrdf
