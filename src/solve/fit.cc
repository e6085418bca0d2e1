#include "pbnbrdf/solve/fit.h"

#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/solve/adam.h"
#include "pbnbrdf/solve/ceres_solvers.h"
#include "pbnbrdf/solve/tiny_lm.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kHeldOutSamples = 4096;
constexpr std::uint64_t kHeldOutSeed = 1;
constexpr int kMostSecondOrderWeights = 10000;

// Samples of the training distribution that no solver sees tell when more samples are wanted:
// where the cost of these exceeds that of the training samples by a factor of kOverfit.
constexpr std::size_t kValidationSamples = 4096;
constexpr std::uint64_t kValidationSeed = 0x9e3779b97f4a7c15;
constexpr double kOverfit = 1.1;

// When a stage is slow, more samples promise more than more iterations; idle, nothing does.
constexpr std::size_t kSlowIterations = 6, kIdleIterations = 30;
constexpr double kSlowFall = 0.3, kIdleFall = 0.03;
constexpr std::size_t kLbfgsPace = 10;  // its iterations to one of Levenberg-Marquardt

// A clock that can be stopped.
class Stopwatch {
 public:
  double Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  // Runs what isn't to be counted.
  template <typename Function>
  auto Exclude(Function function) {
    const Clock::time_point before = Clock::now();
    auto result = function();
    start_ += Clock::now() - before;
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

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

class Fitter {
 public:
  Fitter(const Brdf& material, const FitProblem& problem, const FitOptions& options)
      : options_(options),
        samples_(DrawSamples(material, SampleSet::kTraining, problem.sampling, problem.samples,
                             problem.seed)),
        validation_samples_(DrawSamples(material, SampleSet::kTraining, problem.sampling,
                                        kValidationSamples, problem.seed + kValidationSeed)),
        count_(std::min(problem.first_samples, samples_.size())),
        weights_(InitialWeights(problem.Shape(), samples_, problem.seed, problem.initialization)),
        iterations_left_(options.max_iterations) {
    if (options.solver == Solver::kAdam) count_ = samples_.size();  // it draws its own few
    if (!options.on_iteration) return;
    heldout_ = stopwatch_.Exclude([&] {
      return MakeObjective(problem, DrawSamples(material, SampleSet::kHeldOut, Sampling::kUniform,
                                                kHeldOutSamples, kHeldOutSeed));
    });
  }

  // Minimises from where the last stage ended, on few samples at first and then on more and more.
  void RunStages(const FitProblem& problem) {
    iterations_left_ = options_.max_iterations;
    validation_ = MakeObjective(problem, validation_samples_);
    while (RunStage(problem) && iterations_left_ > 0 && MayContinue()) {
      const double grown = std::ceil(problem.growth * static_cast<double>(count_));
      count_ = grown < static_cast<double>(samples_.size()) ? static_cast<std::size_t>(grown)
                                                            : samples_.size();
    }
  }

  // Whether neither the user nor the clock has ended the fit.
  bool MayContinue() const {
    return summary_.termination != Termination::kInterrupted &&
           stopwatch_.Seconds() < options_.max_seconds;
  }

  const std::vector<double>& weights() const { return weights_; }

  FitSummary Finish() {
    summary_.seconds = stopwatch_.Seconds();
    summary_.samples = count_;
    return summary_;
  }

 private:
  // Whether it ended for want of samples.
  bool RunStage(const FitProblem& problem) {
    enum class End { kNone, kInterrupted, kWantsSamples, kNoGain } end = End::kNone;
    const std::size_t pace = options_.solver == Solver::kLbfgs ? kLbfgsPace : 1;
    Slowdown slow(pace * kSlowIterations, kSlowFall), idle(pace * kIdleIterations, kIdleFall);
    StageOptions stage;
    stage.max_iterations = iterations_left_;
    stage.curvature_samples = options_.curvature_samples;
    stage.function_tolerance = options_.function_tolerance;
    stage.seconds_left = [&] { return options_.max_seconds - stopwatch_.Seconds(); };
    stage.on_iteration = [&](int iteration, double cost) {
      if (options_.on_iteration && !Report(iteration, cost)) end = End::kInterrupted;
      if (options_.solver == Solver::kAdam || end != End::kNone) return end == End::kNone;
      const double validation = validation_->Cost(weights_.data());
      const bool wants_samples = count_ < samples_.size() && validation > kOverfit * cost;
      if (slow.Observe(cost) && wants_samples) end = End::kWantsSamples;
      if (idle.Observe(validation)) end = wants_samples ? End::kWantsSamples : End::kNoGain;
      return end == End::kNone;
    };
    const StageResult result = Minimize(problem, std::span(samples_).first(count_), stage);
    summary_.final_cost = result.cost;
    summary_.iterations += result.iterations;
    iterations_left_ -= result.iterations;
    summary_.termination = result.termination;
    summary_.message = result.message;
    if (end == End::kNoGain || end == End::kWantsSamples) {
      summary_.termination = Termination::kConverged;
      summary_.message = "neither more samples nor more iterations help";
    }
    if (result.termination == Termination::kConverged) return count_ < samples_.size();
    return end == End::kWantsSamples;
  }

  StageResult Minimize(const FitProblem& problem, std::span<const BrdfSample> samples,
                       const StageOptions& stage) {
    ceres::Problem ceres_problem;
    if (options_.jacobian == JacobianMethod::kAutodiff) {
      AddAutodiff(problem, samples, weights_.data(), &ceres_problem);
      return MinimizeCeresLm(&ceres_problem, stage);
    }
    if (options_.solver == Solver::kAdam) {
      return MinimizeAdam(problem, samples, options_.adam, stage, &weights_);
    }
    const std::unique_ptr<Objective> objective = MakeObjective(problem, samples);
    switch (options_.solver) {
      case Solver::kTinyLm:
        return MinimizeTinyLm(objective.get(), stage, &weights_);
      case Solver::kLbfgs:
        return MinimizeCeresLbfgs(objective.get(), stage, &weights_);
      case Solver::kLm:
      case Solver::kAdam:
        break;
    }
    AddCondensed(objective.get(), weights_.data(), &ceres_problem);
    return MinimizeCeresLm(&ceres_problem, stage);
  }

  // Tells the user, who may stop the fit.
  bool Report(int iteration, double cost) {
    FitProgress progress;
    progress.iteration = summary_.iterations + iteration;
    progress.cost = cost;
    progress.seconds = stopwatch_.Seconds();
    return stopwatch_.Exclude([&] {
      progress.heldout_error = heldout_->MeanAbsLogError(weights_.data());
      return options_.on_iteration(progress);
    });
  }

  Stopwatch stopwatch_;
  const FitOptions& options_;
  std::vector<BrdfSample> samples_, validation_samples_;
  std::size_t count_;  // of the samples in use
  std::vector<double> weights_;
  std::unique_ptr<Objective> validation_, heldout_;
  FitSummary summary_;
  int iterations_left_;
};

// The energy term waits until the rest is fitted: from random weights its square outweighs all else
// by orders of magnitude and leads astray, and most materials never need it.
Fit Solve(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  Fitter fitter(material, problem, options);
  if (options.solver == Solver::kAdam) {  // all terms from the start, as published
    fitter.RunStages(problem);
    return {NeuralBrdf(problem.Shape(), fitter.weights()), fitter.Finish()};
  }
  FitProblem without_energy = problem;
  without_energy.energy_weight = 0.0;
  fitter.RunStages(without_energy);
  const bool gains_energy = problem.energy_weight > 0.0 &&
                            EnergyStrata<double>(problem).Cost(fitter.weights().data()) > 0.0;
  if (gains_energy && fitter.MayContinue()) fitter.RunStages(problem);
  FitSummary summary = fitter.Finish();
  summary.energy_stage = gains_energy;
  return {NeuralBrdf(problem.Shape(), fitter.weights()), summary};
}

}  // namespace

void ValidateFit(const FitProblem& problem, const FitOptions& options) {
  problem.Validate();
  options.adam.Validate();
  if (options.max_iterations < 0) {
    Fail("max_iterations = ", options.max_iterations, "; must be >= 0");
  }
  if (!(options.max_seconds > 0.0)) Fail("max_seconds = ", options.max_seconds, "; must be > 0");
  if (!(options.function_tolerance >= 0.0)) {
    Fail("function_tolerance = ", options.function_tolerance, "; must be >= 0");
  }
  const bool second_order = options.solver == Solver::kTinyLm || options.solver == Solver::kLm;
  const int weights = problem.Shape().num_weights();
  if (second_order && weights > kMostSecondOrderWeights) {
    Fail("hidden: makes ", weights, " weights; a second-order solver takes at most ",
         kMostSecondOrderWeights, ", as its memory grows with their square");
  }
  if (options.curvature_samples < 1) Fail("curvature_samples = 0; must be >= 1");
  if (options.threads < 0) Fail("threads = ", options.threads, "; must be >= 0");
  const bool has_squares = second_order || options.jacobian == JacobianMethod::kAutodiff;
  if (has_squares && problem.loss == Loss::kAbsolute) {
    Fail("loss: absolute isn't a sum of squares; it takes --solver=lbfgs or adam");
  }
}

Fit FitBrdf(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  ValidateFit(problem, options);
  const int most_threads = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most_threads)
                                            : most_threads);
  return arena.execute([&] { return Solve(material, problem, options); });
}

}  // namespace pbnbrdf
