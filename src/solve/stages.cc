// How a fit proceeds: short runs from several starts, then stages on more and more samples.
#include <algorithm>
#include <cmath>
#include <limits>

#include "pbnbrdf/base/error.h"
#include "solve/training.h"

namespace pbnbrdf {
namespace {

constexpr int kStartIterations = 12;

// More samples are wanted where the cost of samples that no solver sees exceeds that of the training
// samples by this factor.
constexpr double kOverfit = 1.1;

// A stage is slow if its cost has fallen by less than kSlowFall over kSlowIterations: then more samples
// promise more than more iterations. It is idle if the cost of unseen samples has fallen by less than
// kIdleFall over kIdleIterations: then nothing helps. Of these numbers' neighbours none was better over
// the materials of experiments/solver_comparison; but kIdleFall is for measured materials: with 0.02,
// three of four RGL files had errors 3 to 10 % larger at measured angles, and pictures up to 0.7 dB farther.
constexpr std::size_t kSlowIterations = 6, kIdleIterations = 25;
constexpr double kSlowFall = 0.3, kIdleFall = 0.01;

// Whether a number that is watched has all but ceased to fall.
class Slowdown {
 public:
  // Slow: its least value has fallen by less than a part of `fall` over `iterations`.
  Slowdown(std::size_t iterations, double fall) : iterations_(iterations), fall_(fall) {}

  bool Observe(double value) {
    least_.push_back(least_.empty() ? value : std::min(value, least_.back()));
    if (least_.size() <= iterations_) return false;
    return least_.back() > (1.0 - fall_) * least_[least_.size() - 1 - iterations_];
  }

 private:
  std::size_t iterations_;
  double fall_;
  std::vector<double> least_;  // so far, at each iteration
};

// Why a stage ended; kNone: the solver ended it.
enum class End { kNone, kInterrupted, kWantsSamples, kWantsCurvature, kNoGain };

// What helps a stage that is slow; kNone: to go on.
End Next(const Training& training, double overfit, bool is_idle) {
  if (!training.HasAllSamples() && (is_idle || overfit >= kOverfit)) return End::kWantsSamples;
  if (!is_idle) return End::kNone;
  return training.HasPartOfCurvature() ? End::kWantsCurvature : End::kNoGain;
}

End RunStage(Training* training, int max_iterations) {
  const SolverTraits& traits = training->solver().traits;
  const auto pace = static_cast<std::size_t>(traits.pace);
  Slowdown slow(pace * kSlowIterations, kSlowFall), idle(pace * kIdleIterations, kIdleFall);
  End end = End::kNone;
  training->Minimize(max_iterations, [&](int iteration, double cost) {
    if (!training->Report(iteration, cost)) end = End::kInterrupted;
    if (traits.is_stochastic || end != End::kNone) return end == End::kNone;
    const double validation = training->validation().Cost(training->weights().data());
    const bool is_slow = slow.Observe(cost), is_idle = idle.Observe(validation);
    if (is_slow || is_idle) end = Next(*training, validation / cost, is_idle);
    return end == End::kNone;
  });
  FitSummary& summary = training->summary();
  if (!std::isfinite(summary.final_cost)) Fail("no start: ", summary.message);
  if (summary.termination == Termination::kConverged) {
    return Next(*training, /*overfit=*/1.0, /*is_idle=*/true);
  }
  if (summary.termination == Termination::kDiverged) return End::kNoGain;
  if (end != End::kNone && end != End::kInterrupted) {
    summary.termination = Termination::kConverged;
    summary.message = "neither more samples nor more iterations help";
  }
  return end;
}

}  // namespace

void RunStarts(Training* training) {
  const ScheduleOptions& schedule = training->options().schedule;
  std::vector<double> best;
  double min_cost = std::numeric_limits<double>::infinity();
  for (int start = 0; start < schedule.starts && training->MayContinue(); ++start) {
    if (start > 0) training->StartAnew(start);
    const double cost = training->Minimize(
        std::min(kStartIterations, schedule.max_iterations),
        [&](int iteration, double at) { return training->Report(iteration, at); });
    if (!(cost < min_cost)) continue;
    min_cost = cost;
    best = training->weights();
  }
  if (!best.empty()) training->weights() = best;
}

void RunStages(Training* training, int max_iterations) {
  const int last = training->summary().iterations + max_iterations;
  while (true) {
    const End end = RunStage(training, last - training->summary().iterations);
    if (training->summary().iterations >= last || !training->MayContinue()) return;
    if (end == End::kWantsSamples) {
      training->TakeMoreSamples();
    } else if (end == End::kWantsCurvature) {
      training->TakeMoreCurvature();
    } else {
      return;
    }
  }
}

}  // namespace pbnbrdf
