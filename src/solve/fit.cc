#include "pbnbrdf/solve/fit.h"

#include <ceres/solver.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <cmath>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/problem/energy_strata.h"

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
    if (!on_iteration_) return;
    heldout_ = stopwatch->Exclude([&] {
      return MakeObjective(problem, DrawSamples(material, SampleSet::kHeldOut, Sampling::kUniform,
                                                kHeldOutSamples, kHeldOutSeed));
    });
  }

  // Iterations of earlier stages are counted on.
  void set_first_iteration(int iteration) { first_iteration_ = iteration; }

  bool interrupted() const { return interrupted_; }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (!on_iteration_) return ceres::SOLVER_CONTINUE;
    FitProgress progress;
    progress.iteration = first_iteration_ + summary.iteration;
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
  int first_iteration_ = 0;
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
  ceres_options.use_nonmonotonic_steps = true;  // halves the iterations; the best weights are kept
  ceres_options.max_num_consecutive_invalid_steps = kMostInvalidSteps;
  ceres_options.update_state_every_iteration = true;
  ceres_options.num_threads = 1;  // one block; its threads are ours
  return ceres_options;
}

class Solver {
 public:
  Solver(const Brdf& material, const FitProblem& problem, const FitOptions& options)
      : options_(options),
        samples_(DrawSamples(material, SampleSet::kTraining, problem.sampling, problem.samples,
                             problem.seed)),
        weights_(InitialWeights(problem.Shape(), samples_, problem.seed)),
        callback_(material, problem, options, weights_.data(), &stopwatch_) {}

  // Minimises from where the last stage ended.
  void RunStage(const FitProblem& problem) {
    ceres::Problem ceres_problem;
    std::unique_ptr<Objective> objective;
    if (options_.jacobian == JacobianMethod::kCondensed) {
      objective = MakeObjective(problem, samples_);
      AddCondensed(objective.get(), weights_.data(), &ceres_problem);
    } else {
      AddAutodiff(problem, samples_, weights_.data(), &ceres_problem);
    }
    callback_.set_first_iteration(summary_.iterations);
    ceres::Solver::Options ceres_options =
        CeresOptions(options_, options_.max_seconds - stopwatch_.Seconds());
    ceres_options.callbacks.push_back(&callback_);
    ceres::Solver::Summary ceres_summary;
    ceres::Solve(ceres_options, &ceres_problem, &ceres_summary);
    if (!ceres_summary.IsSolutionUsable()) Fail("the solver failed: ", ceres_summary.message);
    Record(ceres_summary);
  }

  // Whether a further stage is allowed.
  bool MayContinue() const {
    return summary_.termination != Termination::kInterrupted &&
           stopwatch_.Seconds() < options_.max_seconds;
  }

  const std::vector<double>& weights() const { return weights_; }

  FitSummary Finish() {
    summary_.seconds = stopwatch_.Seconds();
    return summary_;
  }

 private:
  void Record(const ceres::Solver::Summary& stage) {
    const int iterations = static_cast<int>(stage.iterations.size()) - 1;
    summary_.iterations += iterations;
    summary_.final_cost = stage.final_cost;
    summary_.message = stage.message;
    if (callback_.interrupted()) {
      summary_.termination = Termination::kInterrupted;
    } else if (stage.termination_type == ceres::CONVERGENCE) {
      summary_.termination = Termination::kConverged;
    } else {
      summary_.termination = iterations >= options_.max_iterations ? Termination::kMaxIterations
                                                                   : Termination::kMaxSeconds;
    }
  }

  Stopwatch stopwatch_;
  const FitOptions& options_;
  std::vector<BrdfSample> samples_;
  std::vector<double> weights_;
  ProgressCallback callback_;
  FitSummary summary_;
};

// The energy term waits until the rest is fitted: from random weights its square outweighs all else
// by orders of magnitude and leads astray, and most materials never need it.
Fit Solve(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  Solver solver(material, problem, options);
  FitProblem without_energy = problem;
  without_energy.energy_weight = 0.0;
  solver.RunStage(without_energy);
  const bool gains_energy = problem.energy_weight > 0.0 &&
                            EnergyStrata<double>(problem).Cost(solver.weights().data()) > 0.0;
  if (gains_energy && solver.MayContinue()) solver.RunStage(problem);
  FitSummary summary = solver.Finish();
  summary.energy_stage = gains_energy;
  return {NeuralBrdf(problem.Shape(), solver.weights()), summary};
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
