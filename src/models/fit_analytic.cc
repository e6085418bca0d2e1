#include "pbnbrdf/models/fit_analytic.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/timer.h"
#include "models/analytic_residual.h"
#include "models/analytic_starts.h"
#include "models/fit_analytic_fields.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Of the starts: a wide loss leads from afar, and few iterations tell which are worth more.
constexpr double kFirstLossScale = 0.03;
constexpr int kFirstIterations = 40;
constexpr std::size_t kMaxFinalists = 2;

// A point that a stage reached.
struct Candidate {
  std::vector<double> numbers;
  double cost = std::numeric_limits<double>::infinity();  // per sample
  int iterations = 0;
  bool converged = false;
  std::string message;
};

struct Stage {
  std::span<const BrdfSample> samples;
  double loss_scale;
  int max_iterations;
  double function_tolerance;
};

class AnalyticFitter {
 public:
  AnalyticFitter(const AnalyticModel& model, int lobes, bool isotropic)
      : model_(model), lobes_(lobes), parameters_(model, lobes, isotropic) {}

  const FreeParameters& parameters() const { return parameters_; }

  // From the candidate's numbers on. Its cost stays infinite if there is none.
  void Run(const Stage& stage, Candidate* candidate) const {
    ceres::Problem problem;
    double* numbers = candidate->numbers.data();
    problem.AddParameterBlock(numbers, static_cast<int>(parameters_.size()));
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      problem.SetParameterLowerBound(numbers, static_cast<int>(i), parameters_.lower()[i]);
      problem.SetParameterUpperBound(numbers, static_cast<int>(i), parameters_.upper()[i]);
    }
    auto* loss = new ceres::SoftLOneLoss(stage.loss_scale);  // one for all; the problem owns it
    for (const BrdfSample& sample : stage.samples) {
      problem.AddResidualBlock(MakeAnalyticResidual(model_, lobes_, parameters_, sample).release(),
                               loss, numbers);
    }
    ceres::Solver::Summary summary;
    ceres::Solve(Options(stage), &problem, &summary);
    candidate->iterations += static_cast<int>(summary.iterations.size());
    candidate->message = summary.message.substr(0, summary.message.find('\n'));
    candidate->converged = summary.termination_type == ceres::CONVERGENCE;
    candidate->cost = summary.IsSolutionUsable() && std::isfinite(summary.final_cost)
                          ? summary.final_cost / static_cast<double>(stage.samples.size())
                          : std::numeric_limits<double>::infinity();
  }

 private:
  // One thread: sums in the same order each time.
  static ceres::Solver::Options Options(const Stage& stage) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = stage.max_iterations;
    options.function_tolerance = stage.function_tolerance;
    options.parameter_tolerance = 1e-12;
    options.gradient_tolerance = 0.0;       // costs are tiny: the relative change decides
    options.max_trust_region_radius = 1e6;  // parameters may be without effect: J'J is singular
    options.num_threads = 1;
    return options;
  }

  const AnalyticModel& model_;
  int lobes_;
  FreeParameters parameters_;
};

// Runs the stage from each candidate, and puts the best ones first.
void RunAll(const AnalyticFitter& fitter, const Stage& stage, tbb::task_arena* arena,
            std::vector<Candidate>* candidates) {
  arena->execute([&] {
    tbb::parallel_for(std::size_t{0}, candidates->size(),
                      [&](std::size_t k) { fitter.Run(stage, &(*candidates)[k]); });
  });
  std::stable_sort(candidates->begin(), candidates->end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  if (!std::isfinite(candidates->front().cost)) {
    Fail("no start of the fit has a finite cost: ", candidates->front().message);
  }
}

// Runs the starts and the best of them to the end. at_hand: candidates that skip the first stage.
Candidate FitLobes(const AnalyticFitter& fitter, const AnalyticFitOptions& options,
                   const std::vector<std::vector<double>>& starts,
                   std::span<const BrdfSample> samples, std::vector<Candidate> at_hand,
                   tbb::task_arena* arena) {
  std::vector<Candidate> candidates;
  for (const std::vector<double>& scalars : starts) {
    candidates.emplace_back();
    candidates.back().numbers = fitter.parameters().FromScalars(scalars);
  }
  const double first_scale = std::max(kFirstLossScale, options.loss_scale);
  const auto first = samples.first(std::min(samples.size(), options.first_samples));
  RunAll(fitter, {first, first_scale, kFirstIterations, 1e-4}, arena, &candidates);
  candidates.resize(std::min(candidates.size(), kMaxFinalists));
  candidates.insert(candidates.end(), at_hand.begin(), at_hand.end());
  RunAll(fitter, {samples, options.loss_scale, options.max_iterations, options.function_tolerance},
         arena, &candidates);
  return candidates.front();
}

}  // namespace

Fields AnalyticFitFields(AnalyticFitOptions* options) {
  Fields fields;
  fields.Group("The fit");
  fields.AddCommon(Integer("lobes", &options->lobes, Between(1, kMaxLobes),
                           "number of lobes of the model, 1 or 2"));
  fields.Add(Number("loss_scale", &options->loss_scale, Above(0.0),
                    "residual at which the robust loss turns from square to linear"));
  fields.Add(Integer("first_samples", &options->first_samples, AtLeast(1),
                     "samples that the starts are compared on"));
  fields.Add(Integer("starts", &options->starts, AtLeast(1),
                     "starting points, from narrow lobes to wide ones; the best ones go on"));
  fields.AddCommon(Integer("max_iterations", &options->max_iterations, AtLeast(1),
                           "maximum number of iterations"));
  fields.Add(Number("function_tolerance", &options->function_tolerance, AtLeast(0.0),
                    "stop when an iteration lowers the cost by a smaller part"));
  return fields;
}

void AnalyticFitOptions::Validate() const {
  AnalyticFitOptions copy = *this;
  AnalyticFitFields(&copy).Check();
  if (threads < 0) Fail("threads = ", threads, "; must be >= 0");
}

AnalyticFit FitAnalytic(std::span<const BrdfSample> samples, bool isotropic,
                        const AnalyticModel& model, const AnalyticFitOptions& options) {
  options.Validate();
  const Timer timer;
  const int lobes = model.lobe.empty() ? 0 : options.lobes;
  const auto first = samples.first(std::min(samples.size(), options.first_samples));
  const int most_threads = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, most_threads)
                                            : tbb::task_arena::automatic);
  std::vector<Candidate> at_hand;
  std::vector<double> scalars;
  Candidate best;
  for (int n = std::min(lobes, 1); n <= lobes; ++n) {
    const AnalyticFitter fitter(model, n, isotropic);
    if (n == 2) {  // the fit of one lobe, with a second one that is hardly there
      at_hand.push_back(best);
      at_hand[0].numbers = fitter.parameters().FromScalars(WithFaintLobe(model, scalars));
    }
    best = FitLobes(fitter, options, AnalyticStarts(model, n, first, options.starts), samples,
                    at_hand, &arena);
    scalars = fitter.parameters().ToBoundedScalars(best.numbers);
  }
  AnalyticFit fit{AnalyticBrdf(model, lobes, scalars), {}};
  fit.summary = {best.cost, best.iterations, best.converged, timer.Seconds(), best.message};
  return fit;
}

}  // namespace pbnbrdf
