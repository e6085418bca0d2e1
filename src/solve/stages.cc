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
// promise more than more iterations. It is idle if over kIdleIterations the error of unseen
// samples (with the energy term: their cost) has fallen by less than ScheduleOptions::error_tolerance, of
// itself and of kFineError: then nothing helps. Of kSlow...'s neighbours none was better over the materials
// of experiments/solver_comparison; kFineError halves the time of fits to smooth formulas.
constexpr std::size_t kSlowIterations = 6, kIdleIterations = 25;
constexpr double kSlowFall = 0.3;
constexpr double kFineError = 1e-4;  // which no picture shows

// Once all samples are in, J'J of more of them makes better steps, which cost more: worth it where the
// cost of unseen samples has fallen by less than kPoorFall over kSlowIterations, up to kSureGrowth times as
// many. Beyond, it pays for some narrow highlights, and hardly for measured materials: so only where the last
// doubling took kWorthwhileFall off an error above kFineError in no more than kWorthwhileIterations, and
// for as long as the error falls by kCostlyFall over kCostlyIterations; then it is kSureGrowth for good.
constexpr double kPoorFall = 0.2;
constexpr std::size_t kSureGrowth = 4;
constexpr double kWorthwhileFall = 0.3;
constexpr int kWorthwhileIterations = 50;
constexpr std::size_t kCostlyIterations = 12;
constexpr double kCostlyFall = 0.1;

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
enum class End { kNone, kInterrupted, kWantsSamples, kWantsCurvature, kCostsTooMuch, kNoGain };

class Stages {
 public:
  explicit Stages(Training* training) : training_(*training) {}

  // At most so many iterations in all.
  void Run(int max_iterations) {
    const int last = training_.summary().iterations + max_iterations;
    while (true) {
      const End end = RunStage(last - training_.summary().iterations);
      if (training_.summary().iterations >= last || !training_.MayContinue()) return;
      if (end == End::kWantsSamples) {
        training_.TakeMoreSamples();
      } else if (end == End::kWantsCurvature) {
        error_before_ = training_.ValidationError();
        training_.GrowCurvature(2 * training_.CurvatureGrowth());
      } else if (end == End::kCostsTooMuch) {
        may_cost_more_ = false;
        training_.GrowCurvature(kSureGrowth);
      } else {
        return;
      }
    }
  }

 private:
  // How a stage stands after so many iterations: the error of unseen samples, and what has ceased to fall.
  struct Signs {
    int iterations = 0;
    double error = 0.0;
    bool is_costly = false;
    bool is_slow = true, is_poor = true, is_idle = true;
    double overfit = 1.0;  // the cost of unseen samples over that of the training samples
  };

  // What helps; kNone: to go on.
  End Next(const Signs& signs) {
    if (!training_.HasAllSamples()) {
      const bool wants = signs.is_idle || (signs.is_slow && signs.overfit >= kOverfit);
      return wants ? End::kWantsSamples : End::kNone;
    }
    if (signs.is_costly && training_.CurvatureGrowth() > kSureGrowth) return End::kCostsTooMuch;
    if (signs.is_poor && IsCurvatureWorthwhile(signs)) return End::kWantsCurvature;
    return signs.is_idle ? End::kNoGain : End::kNone;
  }

  bool IsCurvatureWorthwhile(const Signs& signs) {
    if (!training_.HasPartOfCurvature()) return false;
    if (training_.CurvatureGrowth() < kSureGrowth) return true;
    return may_cost_more_ && signs.iterations <= kWorthwhileIterations &&
           signs.error > kFineError && signs.error < (1.0 - kWorthwhileFall) * error_before_;
  }

  End RunStage(int max_iterations) {
    const SolverTraits& traits = training_.solver().traits;
    const auto pace = static_cast<std::size_t>(traits.pace);
    const double tolerance = training_.options().schedule.error_tolerance;
    Slowdown slow(pace * kSlowIterations, kSlowFall), poor(pace * kSlowIterations, kPoorFall);
    Slowdown idle(pace * kIdleIterations, tolerance);
    Slowdown costly(pace * kCostlyIterations, kCostlyFall);
    End end = End::kNone;
    const int before = training_.summary().iterations;
    training_.Minimize(max_iterations, [&](int iteration, double cost) {
      if (!training_.Report(iteration, cost)) end = End::kInterrupted;
      Signs signs;
      signs.iterations = iteration;
      signs.error = training_.RecordError(iteration);
      if (traits.is_stochastic || end != End::kNone) return end == End::kNone;
      const double validation = training_.ValidationCost();
      signs.overfit = validation / cost;
      signs.is_slow = slow.Observe(cost);
      signs.is_poor = poor.Observe(validation);
      signs.is_idle = idle.Observe(training_.HasEnergy() ? validation : signs.error + kFineError);
      signs.is_costly = costly.Observe(signs.error);
      end = Next(signs);
      return end == End::kNone;
    });
    FitSummary& summary = training_.summary();
    if (!std::isfinite(summary.final_cost)) Fail("no start: ", summary.message);
    if (summary.termination == Termination::kConverged) {
      return Next(
          {.iterations = summary.iterations - before, .error = training_.ValidationError()});
    }
    if (summary.termination == Termination::kDiverged) return End::kNoGain;
    if (end != End::kNone && end != End::kInterrupted) {
      summary.termination = Termination::kConverged;
      summary.message = "neither more samples nor more iterations help";
    }
    return end;
  }

  Training& training_;
  double error_before_ = std::numeric_limits<double>::infinity();  // J'J's last growth
  bool may_cost_more_ = true;  // than J'J of kSureGrowth times the samples
};

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

void RunStages(Training* training, int max_iterations) { Stages(training).Run(max_iterations); }

void RunStagesOfAllWidths(Training* training, int max_iterations) {
  RunStages(training, max_iterations);
  while (!training->HasAllWeights() && training->MayContinue()) {
    training->TakeMoreWeights();
    RunStages(training, max_iterations * training->solver().traits.pace);
  }
}

}  // namespace pbnbrdf
