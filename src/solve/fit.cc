#include "pbnbrdf/solve/fit.h"

#include <ceres/solver.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kHeldOutSamples = 4096;
constexpr std::uint64_t kHeldOutSeed = 1;
constexpr int kMostInvalidSteps = 20;

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

// Hands each iteration to the user, who may stop the fit.
class ProgressCallback final : public ceres::IterationCallback {
 public:
  ProgressCallback(const Brdf& material, const FitProblem& problem, const FitOptions& options,
                   const double* weights, Stopwatch* stopwatch)
      : on_iteration_(options.on_iteration), weights_(weights), stopwatch_(stopwatch) {
    heldout_ = stopwatch->Exclude([&] {
      return MakeObjective(problem, DrawSamples(material, SampleSet::kHeldOut, Sampling::kUniform,
                                                kHeldOutSamples, kHeldOutSeed));
    });
  }

  bool interrupted() const { return interrupted_; }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    FitProgress progress;
    progress.iteration = summary.iteration;
    progress.cost = summary.cost;
    progress.seconds = stopwatch_->Seconds();
    interrupted_ = stopwatch_->Exclude([&] {
      progress.heldout_error = heldout_->MeanAbsLogError(weights_);
      return !on_iteration_(progress);
    });
    return interrupted_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  std::function<bool(const FitProgress&)> on_iteration_;
  const double* weights_;
  Stopwatch* stopwatch_;
  std::unique_ptr<Objective> heldout_;
  bool interrupted_ = false;
};

ceres::Solver::Options CeresOptions(const FitOptions& options, double seconds_left) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres_options.logging_type = ceres::SILENT;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.max_solver_time_in_seconds = std::max(seconds_left, 0.0);
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.parameter_tolerance = 0.0;
  ceres_options.gradient_tolerance = 0.0;  // costs are tiny: the relative change decides
  ceres_options.max_num_consecutive_invalid_steps = kMostInvalidSteps;
  ceres_options.update_state_every_iteration = true;
  ceres_options.num_threads = 1;  // one block; its threads are ours
  return ceres_options;
}

Termination ReadTermination(const ceres::Solver::Summary& summary, const FitOptions& options,
                            bool interrupted) {
  if (interrupted) return Termination::kInterrupted;
  if (summary.termination_type == ceres::CONVERGENCE) return Termination::kConverged;
  const int iterations = static_cast<int>(summary.iterations.size()) - 1;
  return iterations >= options.max_iterations ? Termination::kMaxIterations
                                              : Termination::kMaxSeconds;
}

Fit Solve(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  Stopwatch stopwatch;
  const std::vector<BrdfSample> samples = DrawSamples(
      material, SampleSet::kTraining, problem.sampling, problem.samples, problem.seed);
  const NetworkShape shape = problem.Shape();
  std::vector<double> weights = InitialWeights(shape, samples, problem.seed);
  ceres::Problem ceres_problem;
  std::unique_ptr<Objective> objective;
  if (options.jacobian == JacobianMethod::kCondensed) {
    objective = MakeObjective(problem, samples);
    AddCondensed(objective.get(), weights.data(), &ceres_problem);
  } else {
    AddAutodiff(problem, samples, weights.data(), &ceres_problem);
  }

  ceres::Solver::Options ceres_options =
      CeresOptions(options, options.max_seconds - stopwatch.Seconds());
  std::unique_ptr<ProgressCallback> callback;
  if (options.on_iteration) {
    callback = std::make_unique<ProgressCallback>(material, problem, options, weights.data(),
                                                  &stopwatch);
    ceres_options.callbacks.push_back(callback.get());
  }
  ceres::Solver::Summary ceres_summary;
  ceres::Solve(ceres_options, &ceres_problem, &ceres_summary);
  if (!ceres_summary.IsSolutionUsable()) Fail("the solver failed: ", ceres_summary.message);

  FitSummary summary;
  summary.initial_cost = ceres_summary.initial_cost;
  summary.final_cost = ceres_summary.final_cost;
  summary.iterations = static_cast<int>(ceres_summary.iterations.size()) - 1;
  summary.seconds = stopwatch.Seconds();
  summary.termination = ReadTermination(ceres_summary, options, callback && callback->interrupted());
  summary.message = ceres_summary.message;
  return {NeuralBrdf(shape, std::move(weights)), summary};
}

}  // namespace

void FitOptions::Validate() const {
  if (max_iterations < 0) Fail("max_iterations = ", max_iterations, "; must be >= 0");
  if (!(max_seconds > 0.0)) Fail("max_seconds = ", max_seconds, "; must be > 0");
  if (!(function_tolerance >= 0.0)) {
    Fail("function_tolerance = ", function_tolerance, "; must be >= 0");
  }
  if (threads < 0) Fail("threads = ", threads, "; must be >= 0");
}

Fit FitBrdf(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  problem.Validate();
  options.Validate();
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return Solve(material, problem, options); });
}

}  // namespace pbnbrdf
