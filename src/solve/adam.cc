// Adam [1] on minibatches of the papers' own loss (Loss::kAbsolute): the published recipe, as the
// baseline.
//
// [1] D. Kingma, J. Ba. Adam: A Method for Stochastic Optimization. ICLR 2015.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "kernels/losses.h"
#include "pbnbrdf/base/error.h"
#include "problem/minibatch_gradient.h"
#include "problem/minibatches.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
constexpr double kEpsilon = 1e-15;  // NBRDF's
constexpr std::size_t kWindow = 5;  // epochs whose mean cost is compared

// Steps on one thread, while another one draws the minibatches that come next.
class Adam {
 public:
  Adam(const FitProblem& problem, const EncodedSamples& samples, const AdamOptions& options,
       const std::vector<double>& start)
      : learning_rate_(options.learning_rate),
        stream_(problem, samples, std::min(options.batch, samples.size()), options.energy_angles),
        objective_(problem),
        x_(start.begin(), start.end()) {
    x_.resize(kernels::Padded(static_cast<int>(start.size())));
    for (auto* values : {&gradient_, &mean_, &square_}) values->resize(x_.size());
    stream_.Draw(&current_);
  }

  // Stops within the epoch where stop() says so, asked before each step.
  template <typename Stop>
  void RunEpoch(Stop stop) {
    for (bool ends = false, stopped = false; !ends && !stopped;) {
      ends = current_.ends_epoch;
      const auto step = [&] {
        for (std::size_t b = 0; b < current_.count && !stopped; ++b) {
          stopped = stop();
          if (!stopped) Step(b);
        }
      };
      ParallelFor(2, [&](std::size_t k) { k == 0 ? step() : stream_.Draw(&next_); });
      std::swap(current_, next_);
    }
  }

  void CopyWeights(std::vector<double>* weights) const {
    std::copy_n(x_.begin(), weights->size(), weights->begin());
  }

 private:
  void Step(std::size_t minibatch) {
    objective_.Evaluate(x_.data(), current_, minibatch, gradient_.data());
    ++steps_;
    const double root = std::sqrt(1.0 - std::pow(kBeta2, steps_));
    const double rate = learning_rate_ * root / (1.0 - std::pow(kBeta1, steps_));
    kernels::AdamStep(x_.size(), gradient_.data(), static_cast<float>(rate),
                      static_cast<float>(kBeta1), static_cast<float>(kBeta2),
                      static_cast<float>(kEpsilon * root), mean_.data(), square_.data(), x_.data());
  }

  double learning_rate_;
  MinibatchStream stream_;
  MinibatchGradient objective_;
  Minibatches current_, next_;
  AlignedVector<float> x_, gradient_, mean_, square_;  // padded with zeros
  int steps_ = 0;
};

bool AreFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// The mean of the `count` costs that come before `end`.
double MeanCost(const std::vector<double>& costs, std::size_t end, std::size_t count) {
  return std::accumulate(costs.begin() + (end - count), costs.begin() + end, 0.0) /
         static_cast<double>(count);
}

// Whether the last costs are those of before, but for noise and a part of `tolerance`.
bool HasConverged(const std::vector<double>& costs, double tolerance) {
  if (costs.size() <= 2 * kWindow) return false;  // the first is that of the start
  const double last = MeanCost(costs, costs.size(), kWindow);
  const double before = MeanCost(costs, costs.size() - kWindow, kWindow);
  return std::abs(last - before) < tolerance * before;
}

}  // namespace

// An iteration is an epoch: every sample once, in random order (the problem's seed). All terms take part
// from the start; the energy term takes random incident angles at each step, on a grid of energy_theta x
// energy_phi half vectors.
//
// The cost is that of the objective, over some of the training samples. From epoch to epoch it is noisy:
// converged means that its mean over kWindow epochs differs from that over those before by less than a
// part of function_tolerance. The weights are those of the epoch with the lowest cost; the published
// scripts keep the last, whose cost is higher by a tenth or more, at random. Diverged where the cost or a
// weight isn't finite any more.
StageResult MinimizeAdam(const StageInput& input, const StageOptions& options,
                         std::vector<double>* weights) {
  Adam state(input.problem, input.samples, input.options.adam, *weights);
  std::vector<double> last = *weights, costs;  // after each epoch, and at the start
  int best = 0;                                // epoch
  StageResult result;
  result.cost = std::numeric_limits<double>::infinity();
  const auto out_of_time = [&] { return options.seconds_left && options.seconds_left() <= 0.0; };
  const auto stop = [&](Termination termination, const std::string& message) {
    result.termination = termination;
    result.message = message;
    return result;
  };
  while (true) {
    costs.push_back(input.objective->Cost(last.data()));
    // Weights may overflow before the cost does: tanh makes 1 of an infinite sum.
    if (!std::isfinite(costs.back()) || !AreFinite(last)) {
      return stop(Termination::kDiverged,
                  StrCat("the cost isn't finite after epoch ", result.iterations,
                         "; the best weights are those after epoch ", best,
                         "; try a smaller learning rate"));
    }
    if (costs.back() < result.cost) {
      result.cost = costs.back();
      best = result.iterations;
      *weights = last;
    }
    if (options.on_iteration && !options.on_iteration(result.iterations, result.cost)) {
      return stop(Termination::kInterrupted, "the user stopped it");
    }
    if (HasConverged(costs, options.function_tolerance)) {
      return stop(Termination::kConverged,
                  StrCat("mean cost of the last ", kWindow,
                         " epochs and of those before: ", MeanCost(costs, costs.size(), kWindow),
                         ", ", MeanCost(costs, costs.size() - kWindow, kWindow),
                         "; the best weights are those after epoch ", best));
    }
    if (result.iterations >= options.max_iterations) {
      return stop(
          Termination::kMaxIterations,
          StrCat(result.iterations, " epochs; the best weights are those after epoch ", best));
    }
    if (out_of_time()) return stop(Termination::kMaxSeconds, "the time is used up");
    ++result.iterations;
    state.RunEpoch(out_of_time);
    state.CopyWeights(&last);
  }
}

}  // namespace pbnbrdf
