#include "pbnbrdf/solve/fit.h"

#include <tbb/task_arena.h>

#include <cmath>

#include "pace.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/solve/adam.h"
#include "pbnbrdf/solve/ceres_solvers.h"
#include "pbnbrdf/solve/tiny_lm.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kHeldOutSamples = 32768;
constexpr std::uint64_t kHeldOutSeed = 1;
constexpr int kMostSecondOrderWeights = 10000;

// Samples of the training distribution that no solver sees tell when more samples are wanted:
// where the cost of these exceeds that of the training samples by a factor of kOverfit.
constexpr std::size_t kValidationSamples = 4096;
constexpr std::uint64_t kValidationSeed = 0x9e3779b97f4a7c15;
constexpr double kOverfit = 1.1;

constexpr double kRoundingShare = 0.01;
constexpr int kStartIterations = 12;
constexpr std::uint64_t kStartSeed = 0xbf58476d1ce4e5b9;

// When a stage is slow, more samples promise more than more iterations; idle, nothing does.
constexpr std::size_t kSlowIterations = 6, kIdleIterations = 25;
constexpr double kSlowFall = 0.3, kIdleFall = 0.02;
constexpr std::size_t kCurvatureGrowth = 4;
constexpr std::size_t kLbfgsPace = 10;  // its iterations to one of Levenberg-Marquardt

class Fitter {
 public:
  Fitter(const Brdf& material, const FitProblem& problem, const FitOptions& options)
      : options_(options),
        most_samples_(problem.samples),
        stream_(material, SampleSet::kTraining, problem.sampling, problem.seed),
        validation_samples_(DrawSamples(material, SampleSet::kTraining, problem.sampling,
                                        kValidationSamples, problem.seed + kValidationSeed)),
        curvature_samples_(options.curvature_samples) {
    const bool grows = options.solver != Solver::kAdam;  // which draws its own few
    stream_.Draw(grows ? std::min(problem.first_samples, most_samples_) : most_samples_, &samples_);
    weights_ = options.initial_weights;
    if (weights_.empty()) weights_ = RandomWeights(problem, 0);
    if (!options.on_iteration) return;
    heldout_ = stopwatch_.Exclude([&] {
      return MakeObjective(problem, DrawSamples(material, SampleSet::kHeldOut, Sampling::kUniform,
                                                kHeldOutSamples, kHeldOutSeed));
    });
  }

  // Leaves the best of several short runs.
  void RunStarts(const FitProblem& problem) {
    std::vector<double> best;
    double least = std::numeric_limits<double>::infinity();
    for (int start = 0; start < options_.starts && MayContinue(); ++start) {
      weights_ = RandomWeights(problem, start);
      StageOptions stage = MakeStage();
      stage.max_iterations = std::min(kStartIterations, options_.max_iterations);
      stage.on_iteration = [&](int iteration, double cost) { return Report(iteration, cost); };
      const double cost = Run(problem, stage);
      if (!(cost < least)) continue;
      least = cost;
      best = weights_;
    }
    if (!best.empty()) weights_ = best;
  }

  // Minimises from where the last stage ended, on few samples at first and then on more and more.
  void RunStages(const FitProblem& problem) {
    iterations_left_ = options_.max_iterations;
    validation_ = MakeObjective(problem, validation_samples_);
    while (true) {
      const End end = RunStage(problem);
      if (iterations_left_ == 0 || !MayContinue()) return;
      if (end == End::kWantsSamples) {
        const double grown = std::ceil(problem.growth * static_cast<double>(samples_.size()));
        const double most = static_cast<double>(most_samples_);
        stream_.Draw(static_cast<std::size_t>(std::min(grown, most)) - samples_.size(), &samples_);
      } else if (end == End::kWantsCurvature) {
        curvature_samples_ *= kCurvatureGrowth;
      } else {
        return;
      }
    }
  }

  // Whether neither the user nor the clock has ended the fit.
  bool MayContinue() const {
    return summary_.termination != Termination::kInterrupted &&
           stopwatch_.Seconds() < options_.max_seconds;
  }

  const std::vector<double>& weights() const { return weights_; }

  FitSummary Finish(const FitProblem& problem) {
    summary_.seconds = stopwatch_.Seconds();
    summary_.samples = samples_.size();
    summary_.precision_limited =
        problem.precision == Precision::kSingle && !AgreesInDouble(problem);
    return summary_;
  }

 private:
  enum class End { kNone, kInterrupted, kWantsSamples, kWantsCurvature, kNoGain };

  // What it ended for; kNone: for the solver's own reasons.
  End RunStage(const FitProblem& problem) {
    End end = End::kNone;
    const std::size_t pace = options_.solver == Solver::kLbfgs ? kLbfgsPace : 1;
    Slowdown slow(pace * kSlowIterations, kSlowFall), idle(pace * kIdleIterations, kIdleFall);
    StageOptions stage = MakeStage();
    stage.max_iterations = iterations_left_;
    stage.on_iteration = [&](int iteration, double cost) {
      if (!Report(iteration, cost)) end = End::kInterrupted;
      if (options_.solver == Solver::kAdam || end != End::kNone) return end == End::kNone;
      const double validation = validation_->Cost(weights_.data());
      const bool is_slow = slow.Observe(cost), is_idle = idle.Observe(validation);
      if (is_slow || is_idle) end = Next(validation / cost, is_idle);
      return end == End::kNone;
    };
    Run(problem, stage);
    if (summary_.termination == Termination::kConverged)
      return Next(/*overfit=*/1.0, /*is_idle=*/true);
    if (end != End::kNone && end != End::kInterrupted) {
      summary_.termination = Termination::kConverged;
      summary_.message = "neither more samples nor more iterations help";
    }
    return end;
  }

  // Whether rounding plays no part in the cost.
  bool AgreesInDouble(FitProblem problem) const {
    const double single = MakeObjective(problem, validation_samples_)->Cost(weights_.data());
    problem.precision = Precision::kDouble;
    const double exact = MakeObjective(problem, validation_samples_)->Cost(weights_.data());
    return std::abs(single - exact) <= kRoundingShare * exact;
  }

  StageOptions MakeStage() const {
    StageOptions stage;
    stage.curvature_samples = curvature_samples_;
    stage.function_tolerance = options_.function_tolerance;
    stage.seconds_left = [this] { return options_.max_seconds - stopwatch_.Seconds(); };
    return stage;
  }

  // Returns the cost.
  double Run(const FitProblem& problem, const StageOptions& stage) {
    const StageResult result = Minimize(problem, samples_, stage);
    summary_.final_cost = result.cost;
    summary_.iterations += result.iterations;
    iterations_left_ -= result.iterations;
    summary_.termination = result.termination;
    summary_.message = result.message;
    return result.cost;
  }

  // Of the start-th start.
  std::vector<double> RandomWeights(const FitProblem& problem, int start) const {
    return InitialWeights(problem.Shape(), samples_, problem.seed + start * kStartSeed,
                          problem.initialization);
  }

  // What a slow stage wants; kNone: to go on.
  End Next(double overfit, bool is_idle) const {
    if (samples_.size() < most_samples_ && (is_idle || overfit >= kOverfit)) {
      return End::kWantsSamples;
    }
    if (!is_idle) return End::kNone;
    const bool in_parts =
        options_.solver == Solver::kTinyLm && curvature_samples_ < samples_.size();
    return in_parts ? End::kWantsCurvature : End::kNoGain;
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

  // Tells the user, if there is one, who may stop the fit.
  bool Report(int iteration, double cost) {
    if (!options_.on_iteration) return true;
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
  std::size_t most_samples_;
  SampleStream stream_;
  std::vector<BrdfSample> samples_, validation_samples_;
  std::size_t curvature_samples_;
  std::vector<double> weights_;
  std::unique_ptr<Objective> validation_, heldout_;
  FitSummary summary_;
  int iterations_left_ = 0;
};

// The energy term waits until the rest is fitted: from random weights its square outweighs all else
// by orders of magnitude and leads astray, and most materials never need it.
Fit Solve(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  Fitter fitter(material, problem, options);
  if (options.solver == Solver::kAdam) {  // all terms from the start, as published
    fitter.RunStages(problem);
    return {NeuralBrdf(problem.Shape(), fitter.weights()), fitter.Finish(problem)};
  }
  FitProblem without_energy = problem;
  without_energy.energy_weight = 0.0;
  if (options.starts > 1) fitter.RunStarts(without_energy);
  fitter.RunStages(without_energy);
  const bool gains_energy = problem.energy_weight > 0.0 &&
                            EnergyStrata<double>(problem).Cost(fitter.weights().data()) > 0.0;
  if (gains_energy && fitter.MayContinue()) fitter.RunStages(problem);
  FitSummary summary = fitter.Finish(without_energy);
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
  if (options.starts < 1) Fail("starts = ", options.starts, "; must be >= 1");
  if (options.starts > 1 && options.solver == Solver::kAdam) Fail("starts: adam takes one only");
  if (options.starts > 1 && !options.initial_weights.empty()) {
    Fail("starts: there is but one from given weights");
  }
  if (!options.initial_weights.empty() &&
      options.initial_weights.size() != static_cast<std::size_t>(problem.Shape().num_weights())) {
    Fail("initial_weights: ", options.initial_weights.size(), " numbers, a ",
         problem.Shape().Description(), " network has ", problem.Shape().num_weights());
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
  if (material.IsIsotropic() && !IsIsotropic(problem.encoding)) {
    Fail("encoding: ", NameOf(kEncodings, problem.encoding),
         " is for anisotropic materials; an isotropic one has samples at phi_h = 0 only");
  }
  const int most_threads = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most_threads)
                                            : most_threads);
  return arena.execute([&] { return Solve(material, problem, options); });
}

}  // namespace pbnbrdf
