#include "pbnbrdf/solve/half_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/half.h"
#include "base/text.h"
#include "kernels/cholesky.h"
#include "network/batched_mlp.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/problem/objective.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/encoded_samples.h"
#include "solve/energy_correction.h"

namespace pbnbrdf {
namespace {

constexpr int kMostWeights = 5000;
constexpr std::size_t kSamples = 16384, kCurvatureParts = 2;
constexpr double kMinCosine = 0.05;  // below which a sample has no more weight
constexpr std::uint64_t kSeed = 1;
constexpr int kRounds = 32;  // in each of which so many weights are rounded as in any other
constexpr int kSteps = 3;    // of the free weights after each round
constexpr int kTrials = 6;   // of damping for each step
constexpr double kFirstDamping = 1e-6, kLeastDamping = 1e-9, kDampingFactor = 10.0;
constexpr double kMinDiagonal = 1e-8;  // of the largest
// What the values are multiplied by, if the rounded network's albedo exceeds 1 otherwise.
constexpr double kScales[] = {1.0, 0.9995, 0.999, 0.998};
constexpr std::size_t kTestSamples = 65536;
constexpr double kMost = 0.99;  // of the changes

// To the values of a network, in the least squares of log(1 + f cos theta_i).
FitProblem ProblemOf(const NetworkShape& shape) {
  FitProblem problem;
  problem.network = NetworkOptions::Of(shape);
  problem.terms.weights = {{"log", 1.0}};
  problem.terms.loss = Loss::kL2;
  return problem;
}

double Rounded(double weight) {
  const double half = NearestHalf(weight);
  if (!std::isfinite(half)) Fail("weight ", weight, " is beyond half precision, ", kMostHalf);
  return half;
}

class Rounding {
 public:
  Rounding(const NeuralBrdf& network, std::span<const BrdfSample> samples)
      : objective_(MakeObjective(ProblemOf(network.shape()), Precision::kDouble, samples)),
        weights_(network.weights()),
        free_(weights_.size()) {
    std::iota(free_.begin(), free_.end(), std::size_t{0});
    Linearize();
  }

  std::vector<double> Run() {
    for (int rounds = kRounds; rounds > 0; --rounds) {
      RoundCostliest((free_.size() + static_cast<std::size_t>(rounds) - 1) /
                     static_cast<std::size_t>(rounds));
      if (free_.empty()) break;
      Linearize();
      double damping = kFirstDamping;
      for (int k = 0; k < kSteps && Improve(&damping); ++k) Linearize();
    }
    return weights_;
  }

 private:
  // J'J of another part of the samples each time.
  void Linearize() {
    if (!objective_->Linearize(weights_.data(), {linearizations_++, kCurvatureParts}, &at_)) {
      Fail("half precision: the network's values aren't finite");
    }
  }

  double Curvature(std::size_t i, std::size_t j) const {
    return at_.hessian[i * weights_.size() + j];
  }

  // Of those that are free, the weights whose rounding costs most, to first order.
  void RoundCostliest(std::size_t count) {
    const auto cost = [&](std::size_t i) {
      const double change = NearestHalf(weights_[i]) - weights_[i];
      return change * change * Curvature(i, i);
    };
    const auto end = free_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(free_.begin(), end, free_.end(),
                     [&](std::size_t i, std::size_t j) { return cost(i) > cost(j); });
    for (auto i = free_.begin(); i != end; ++i) weights_[*i] = Rounded(weights_[*i]);
    free_.erase(free_.begin(), end);
  }

  // A step of the free weights that lowers the cost; false if none was found.
  bool Improve(double* damping) {
    for (int k = 0; k < kTrials; ++k) {
      const std::vector<double> trial = Step(*damping);
      if (!trial.empty() && objective_->Cost(trial.data()) < at_.cost) {
        weights_ = trial;
        *damping = std::max(*damping / kDampingFactor, kLeastDamping);
        return true;
      }
      *damping *= kDampingFactor;
    }
    return false;
  }

  // The weights after a step of Levenberg and Marquardt; none if there is no such step.
  std::vector<double> Step(double damping) const {
    const int size = static_cast<int>(free_.size());
    double largest = 0.0;
    for (const std::size_t i : free_) largest = std::max(largest, Curvature(i, i));
    Cholesky cholesky(size);
    std::vector<double> step(free_.size());
    for (int r = 0; r < size; ++r) {
      double* row = cholesky.row(r);
      for (int c = 0; c <= r; ++c) row[c] = Curvature(free_[r], free_[c]);
      row[r] += damping * std::max(row[r], kMinDiagonal * largest);
      step[r] = -at_.gradient[free_[r]];
    }
    if (!cholesky.Factor()) return {};
    cholesky.Solve(step.data());
    std::vector<double> weights = weights_;
    for (int r = 0; r < size; ++r) weights[free_[r]] += step[r];
    return weights;
  }

  std::unique_ptr<Objective> objective_;
  std::vector<double> weights_;
  std::vector<std::size_t> free_;  // weights that aren't rounded yet
  Linearization at_;
  std::size_t linearizations_ = 0;
};

// What the output unit makes of the network's outputs without its clamp at 0: values below 0 stay what they are, or
// nothing would say that they are to stay below.
void TakeValuesBelow0(const NeuralBrdf& network, std::vector<BrdfSample>* samples) {
  const NetworkShape& shape = network.shape();
  const EncodedSamples encoded(shape.encoding(), *samples);
  BatchedMlp<double> mlp(shape, 1);
  for (std::size_t n = 0; n < samples->size(); ++n) {
    const std::size_t place = n % kernels::kBatch;
    if (place == 0) {
      mlp.Forward(network.weights().data(), encoded.inputs().batch(n / kernels::kBatch));
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const double z = mlp.output()[c * kernels::kBatch + place];
      if (z < 0.0) (*samples)[n].value[c] = std::expm1(z);
    }
  }
}

// Values that the rounded network should have. Residuals are of f cos theta_i; here f counts, hence the weights.
std::vector<BrdfSample> WantedValues(const NeuralBrdf& network, double scale) {
  std::vector<BrdfSample> samples =
      DrawSamples(network, SampleSet::kTraining, Sampling::kHighlight, kSamples, kSeed);
  TakeValuesBelow0(network, &samples);
  for (BrdfSample& sample : samples) {
    for (double& value : sample.value) value *= scale;
    const double cos_i = std::max(sample.pair.wi.z, kMinCosine);
    sample.weight = kMinCosine * kMinCosine / (cos_i * cos_i);
  }
  return samples;
}

// What it differs by from the network before, which its metadata then says, too.
void MeasureChange(const NeuralBrdf& network, HalfWeights* rounded) {
  const std::vector<BrdfSample> samples =
      DrawSamples(network, SampleSet::kHeldOut, Sampling::kHighlight, kTestSamples, kSeed);
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : samples) pairs.push_back(sample.pair);
  std::vector<Rgb> values(pairs.size());
  rounded->network.Evaluate(pairs, values);
  std::vector<double> changes;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    for (int c = 0; c < 3; ++c) {
      const double f = samples[n].value[c];
      changes.push_back(std::abs(values[n][c] - f) / (1.0 + f));
    }
  }
  const auto size = static_cast<double>(changes.size());
  rounded->mean_change = std::accumulate(changes.begin(), changes.end(), 0.0) / size;
  const auto large = changes.begin() + static_cast<std::ptrdiff_t>(kMost * size);
  std::nth_element(changes.begin(), large, changes.end());
  rounded->most_change = *large;
  NeuralBrdf::Metadata metadata = network.metadata();
  metadata["half_precision"] =
      StrCat("changed by ", rounded->mean_change, " (1 + f) in the mean, at 99 % by at most ",
             rounded->most_change, " (1 + f)");
  metadata["max_directional_albedo"] = FormatNumber(rounded->max_albedo);
  rounded->network = NeuralBrdf(network.shape(), rounded->network.weights(), std::move(metadata));
}

double MaxAlbedo(const NeuralBrdf& network) {
  return Largest(LargestAlbedos(AlbedoProfile(network, {})));
}

}  // namespace

HalfWeights ToHalfWeights(const NeuralBrdf& network) {
  const NetworkShape& shape = network.shape();
  if (shape.num_weights() > kMostWeights) {
    Fail("half precision: ", shape.Description(), " has ", shape.num_weights(),
         " weights; at most ", kMostWeights, " can be rounded");
  }
  const bool conserves = MaxAlbedo(network) <= 1.0;
  for (const double scale : kScales) {
    HalfWeights rounded = {
        NeuralBrdf(shape, Rounding(network, WantedValues(network, scale)).Run())};
    rounded.max_albedo = MaxAlbedo(rounded.network);
    if (conserves && rounded.max_albedo > kMaxAlbedo) continue;
    MeasureChange(network, &rounded);
    return rounded;
  }
  Fail("half precision: the rounded network makes energy");
}

}  // namespace pbnbrdf
