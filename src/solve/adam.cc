#include "pbnbrdf/solve/adam.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/problem/minibatch_gradient.h"

namespace pbnbrdf {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
constexpr float kEpsilon = 1e-15f;  // NBRDF's
constexpr std::size_t kCostSamples = 4096;

// Fisher-Yates; std::shuffle differs between libraries. Below 2^32 numbers.
void Shuffle(std::vector<std::uint32_t>* order, std::mt19937_64* random) {
  for (std::size_t left = order->size(); left > 1; --left) {
    const std::size_t chosen = ((*random)() >> 32) * left >> 32;
    std::swap((*order)[left - 1], (*order)[chosen]);
  }
}

class Adam {
 public:
  Adam(std::size_t size, double learning_rate)
      : learning_rate_(learning_rate), mean_(size), square_(size) {}

  void Step(const std::vector<float>& gradient, std::vector<float>* x) {
    ++steps_;
    const double root = std::sqrt(1.0 - std::pow(kBeta2, steps_));
    const float rate = static_cast<float>(learning_rate_ * root / (1.0 - std::pow(kBeta1, steps_)));
    const float epsilon = static_cast<float>(kEpsilon * root);
    constexpr float kB1 = static_cast<float>(kBeta1), kB2 = static_cast<float>(kBeta2);
    for (std::size_t i = 0; i < x->size(); ++i) {
      const float g = gradient[i];
      mean_[i] = kB1 * mean_[i] + (1.0f - kB1) * g;
      square_[i] = kB2 * square_[i] + (1.0f - kB2) * g * g;
      (*x)[i] -= rate * mean_[i] / (std::sqrt(square_[i]) + epsilon);
    }
  }

 private:
  double learning_rate_;
  std::vector<float> mean_, square_;
  int steps_ = 0;
};

}  // namespace

void AdamOptions::Validate() const {
  if (batch < 1) Fail("batch = ", batch, "; must be >= 1");
  if (!(learning_rate > 0.0) || !std::isfinite(learning_rate)) {
    Fail("learning_rate = ", learning_rate, "; must be finite and > 0");
  }
}

StageResult MinimizeAdam(const FitProblem& problem, std::span<const BrdfSample> samples,
                         const AdamOptions& adam, const StageOptions& options,
                         std::vector<double>* weights) {
  MinibatchGradient objective(problem, samples);
  const auto cost = MakeObjective(problem, samples.first(std::min(kCostSamples, samples.size())));
  Adam update(weights->size(), adam.learning_rate);
  std::mt19937_64 random(problem.seed);
  std::vector<std::uint32_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0u);
  const std::size_t batch = std::min(adam.batch, samples.size());
  std::vector<float> x(weights->begin(), weights->end()), gradient(weights->size());
  StageResult result;
  const auto out_of_time = [&] { return options.seconds_left && options.seconds_left() <= 0.0; };
  const auto stop = [&](Termination termination, const std::string& message) {
    result.termination = termination;
    result.message = message;
    return result;
  };
  while (true) {
    result.cost = cost->MeanAbsLogError(weights->data());
    if (!std::isfinite(result.cost)) {
      Fail("Adam diverged in epoch ", result.iterations, "; try a smaller learning rate");
    }
    if (options.on_iteration && !options.on_iteration(result.iterations, result.cost)) {
      return stop(Termination::kInterrupted, "the user stopped it");
    }
    if (result.iterations >= options.max_iterations) {
      return stop(Termination::kMaxIterations, StrCat(result.iterations, " epochs"));
    }
    if (out_of_time()) return stop(Termination::kMaxSeconds, "the time is used up");
    ++result.iterations;
    Shuffle(&order, &random);
    for (std::size_t first = 0; first + batch <= order.size() && !out_of_time(); first += batch) {
      objective.Evaluate(x.data(), std::span(order).subspan(first, batch), gradient.data());
      update.Step(gradient, &x);
    }
    weights->assign(x.begin(), x.end());
  }
}

}  // namespace pbnbrdf
