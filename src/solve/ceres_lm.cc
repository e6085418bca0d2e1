#include "pbnbrdf/solve/ceres_lm.h"

#include <ceres/solver.h>

#include <algorithm>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr int kMostInvalidSteps = 20;

class IterationCallback final : public ceres::IterationCallback {
 public:
  explicit IterationCallback(const StageOptions& options) : options_(options) {}

  bool interrupted() const { return interrupted_; }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    interrupted_ = options_.on_iteration && !options_.on_iteration(summary.iteration, summary.cost);
    return interrupted_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const StageOptions& options_;
  bool interrupted_ = false;
};

ceres::Solver::Options CeresOptions(const StageOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres_options.logging_type = ceres::SILENT;
  ceres_options.max_num_iterations = options.max_iterations;
  if (options.seconds_left) {
    ceres_options.max_solver_time_in_seconds = std::max(options.seconds_left(), 0.0);
  }
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.parameter_tolerance = 0.0;
  ceres_options.gradient_tolerance = 0.0;  // costs are tiny: the relative change decides
  ceres_options.use_nonmonotonic_steps = true;  // halves the iterations; the best weights are kept
  ceres_options.max_num_consecutive_invalid_steps = kMostInvalidSteps;
  ceres_options.update_state_every_iteration = true;
  ceres_options.num_threads = 1;  // one block, whose threads are its own
  return ceres_options;
}

}  // namespace

StageResult MinimizeCeresLm(ceres::Problem* problem, const StageOptions& options) {
  IterationCallback callback(options);
  ceres::Solver::Options ceres_options = CeresOptions(options);
  ceres_options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(ceres_options, problem, &summary);
  if (!summary.IsSolutionUsable()) Fail("the solver failed: ", summary.message);

  StageResult result;
  result.cost = summary.final_cost;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.message = summary.message;
  if (callback.interrupted()) {
    result.termination = Termination::kInterrupted;
  } else if (summary.termination_type == ceres::CONVERGENCE) {
    result.termination = Termination::kConverged;
  } else {
    result.termination = result.iterations >= options.max_iterations ? Termination::kMaxIterations
                                                                     : Termination::kMaxSeconds;
  }
  return result;
}

}  // namespace pbnbrdf
