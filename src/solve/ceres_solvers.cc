// Ceres' own minimisers.
#include <ceres/first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "pbnbrdf/problem/ceres_problem.h"
#include "solve/solver.h"

namespace pbnbrdf {
namespace {

constexpr int kMaxInvalidSteps = 20;
constexpr int kLbfgsRank = 30;

class IterationCallback final : public ceres::IterationCallback {
 public:
  explicit IterationCallback(const StageOptions& options) : options_(options) {}

  bool interrupted() const { return interrupted_; }
  bool out_of_time() const { return out_of_time_; }

  // The time is asked for here, as Ceres' own clock also counts what on_iteration does.
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    interrupted_ = options_.on_iteration && !options_.on_iteration(summary.iteration, summary.cost);
    out_of_time_ = options_.seconds_left && options_.seconds_left() <= 0.0;
    return interrupted_ || out_of_time_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                        : ceres::SOLVER_CONTINUE;
  }

 private:
  const StageOptions& options_;
  bool interrupted_ = false, out_of_time_ = false;
};

// What the options of both solvers have in common.
template <typename CeresOptions>
CeresOptions CommonOptions(const StageOptions& options, ceres::IterationCallback* callback) {
  CeresOptions ceres_options;
  ceres_options.logging_type = ceres::SILENT;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.parameter_tolerance = 0.0;
  ceres_options.gradient_tolerance = 0.0;  // costs are tiny: the relative change decides
  ceres_options.update_state_every_iteration = true;
  ceres_options.callbacks.push_back(callback);
  return ceres_options;
}

// Ceres prints whole vectors below the first line of some of its messages.
std::string OneLine(const std::string& message) { return message.substr(0, message.find('\n')); }

template <typename CeresSummary>
StageResult ReadSummary(const CeresSummary& summary, const IterationCallback& callback) {
  StageResult result;
  result.cost =
      summary.iterations.empty() ? std::numeric_limits<double>::infinity() : summary.final_cost;
  result.iterations = std::max(static_cast<int>(summary.iterations.size()) - 1, 0);
  result.message = OneLine(summary.message);
  if (callback.interrupted()) {
    result.termination = Termination::kInterrupted;
  } else if (summary.termination_type == ceres::CONVERGENCE) {
    result.termination = Termination::kConverged;
  } else if (callback.out_of_time()) {
    result.termination = Termination::kMaxSeconds;
    result.message = "the time is used up";
  } else if (!summary.IsSolutionUsable()) {
    result.termination = Termination::kDiverged;
  } else {
    result.termination = Termination::kMaxIterations;
  }
  return result;
}

// The cost and its gradient as a function of all weights.
class CostAndGradient final : public ceres::FirstOrderFunction {
 public:
  explicit CostAndGradient(Objective* objective) : objective_(objective) {}

  int NumParameters() const override { return objective_->shape().num_weights(); }

  bool Evaluate(const double* weights, double* cost, double* gradient) const override {
    if (gradient != nullptr) return objective_->Gradient(weights, cost, gradient);
    *cost = objective_->Cost(weights);
    return std::isfinite(*cost);
  }

 private:
  Objective* objective_;
};

// Levenberg-Marquardt (trust region) on a problem whose parameter blocks lie in the caller's weights.
// Diverged if Ceres finds no usable step.
StageResult SolveByTrustRegion(ceres::Problem* problem, const StageOptions& options) {
  IterationCallback callback(options);
  auto ceres_options = CommonOptions<ceres::Solver::Options>(options, &callback);
  ceres_options.initial_trust_region_radius = options.first_radius;
  ceres_options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres_options.use_nonmonotonic_steps = true;  // halves the iterations; the best weights are kept
  ceres_options.max_num_consecutive_invalid_steps = kMaxInvalidSteps;
  ceres_options.num_threads = 1;  // one block, whose threads are its own
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, problem, &summary);
  StageResult result = ReadSummary(summary, callback);
  result.last_radius = options.first_radius;
  for (const ceres::IterationSummary& iteration : summary.iterations) {
    result.last_radius = iteration.trust_region_radius;
    if (iteration.iteration == 0 || iteration.step_is_successful) continue;
    ++(iteration.step_is_valid ? result.rejected_steps : result.failed_factorizations);
  }
  return result;
}

}  // namespace

StageResult MinimizeCeresLm(const StageInput& input, const StageOptions& options,
                            std::vector<double>* weights) {
  ceres::Problem problem;
  AddCondensed(input.objective, weights->data(), &problem);
  return SolveByTrustRegion(&problem, options);
}

StageResult MinimizeAutodiff(const StageInput& input, const StageOptions& options,
                             std::vector<double>* weights) {
  ceres::Problem problem;
  AddAutodiff(input.problem, input.samples.first(input.objective->num_samples()), input.strata,
              weights->data(), &problem);
  return SolveByTrustRegion(&problem, options);
}

// With line search. Converged too where that finds no lower cost, as at the kinks of Loss::kAbsolute.
// Diverged if the objective isn't finite at the start.
StageResult MinimizeCeresLbfgs(const StageInput& input, const StageOptions& options,
                               std::vector<double>* weights) {
  IterationCallback callback(options);
  auto ceres_options = CommonOptions<ceres::GradientProblemSolver::Options>(options, &callback);
  ceres_options.max_lbfgs_rank = kLbfgsRank;
  const ceres::GradientProblem problem(new CostAndGradient(input.objective));
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(ceres_options, problem, weights->data(), &summary);
  if (!summary.IsSolutionUsable() && !summary.iterations.empty()) {
    // The line search finds no lower cost, at a kink of absolute values or where rounding hides the
    // slope: there is nothing left to gain, and the weights are those of the last iteration.
    summary.termination_type = ceres::CONVERGENCE;
    summary.final_cost = summary.iterations.back().cost;
  }
  StageResult result = ReadSummary(summary, callback);
  // Where the gradient is 0 at the start, Ceres reports no iteration and no cost.
  if (summary.iterations.empty() && summary.IsSolutionUsable()) {
    result.cost = input.objective->Cost(weights->data());
  }
  return result;
}

}  // namespace pbnbrdf
