#include "pbnbrdf/models/fit_analytic.h"

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "base/timer.h"
#include "models/analytic_residual.h"
#include "models/fit_analytic_fields.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Of the starts: a wide loss leads from afar, and few iterations tell which are worth more.
constexpr double kFirstLossScale = 0.03;
constexpr int kFirstIterations = 40;
constexpr std::size_t kMaxFinalists = 2;

constexpr double kDarkerPart = 0.3;  // of the samples, the brightest of which is the diffuse part
constexpr double kBrighterPart = 0.02;  // of the samples: the highlight
constexpr double kFaint = 1e-4;         // scale of a lobe
constexpr double kWidthOfSecond = 0.5;  // part of the way from the first lobe's width to `wide`

// The channel's value that the given part of the samples doesn't exceed.
double Quantile(std::span<const BrdfSample> samples, int channel, double part) {
  std::vector<double> values;
  for (const BrdfSample& sample : samples) values.push_back(sample.value[channel]);
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// place: 0 the narrowest, 1 the widest.
double WidthAt(const ModelParameter& parameter, double place) {
  return parameter.narrow * std::pow(parameter.wide / parameter.narrow, place);
}

// The channel's factor by which the lobes alone, with scale 1, are as bright as the highlight
// beyond the diffuse part.
double LobeFactor(const AnalyticModel& model, int lobes, const std::vector<double>& scalars,
                  std::span<const BrdfSample> samples, int channel, double diffuse) {
  const double bright = Quantile(samples, channel, 1.0 - kBrighterPart);
  double sum = 0.0, lobe_sum = 0.0;
  for (const BrdfSample& sample : samples) {
    if (sample.value[channel] < bright) continue;
    sum += std::max(0.0, sample.value[channel] - diffuse);
    lobe_sum +=
        model.evaluate(ReflectionGeometry(sample.pair), scalars.data(), lobes)[channel] - diffuse;
  }
  return lobe_sum > 0.0 ? sum / lobe_sum : 1.0;
}

std::vector<double> StartAt(const AnalyticModel& model, int lobes,
                            std::span<const BrdfSample> samples, double place) {
  const std::vector<PlacedParameter> all = PlacedParameters(model, lobes);
  std::vector<double> scalars(
      static_cast<std::size_t>(model.BaseSize() + lobes * model.LobeSize()));
  Rgb diffuse = {};
  for (const PlacedParameter& placed : all) {
    const ModelParameter& parameter = *placed.parameter;
    const double width_place = placed.lobe == 0 ? place : place + kWidthOfSecond * (1.0 - place);
    for (int c = 0; c < parameter.size; ++c) {
      double& scalar = scalars[placed.first + static_cast<std::size_t>(c)];
      scalar = parameter.initial;
      if (parameter.role == FitRole::kScale) scalar = 1.0;
      if (parameter.role == FitRole::kWidth) scalar = WidthAt(parameter, width_place);
      if (parameter.role == FitRole::kDiffuse) {
        diffuse[c] = Quantile(samples, c, kDarkerPart);
        scalar = std::clamp(diffuse[c] * std::numbers::pi, parameter.lower, parameter.upper);
      }
    }
  }
  for (const PlacedParameter& placed : all) {
    if (placed.parameter->role != FitRole::kScale) continue;
    for (int c = 0; c < 3; ++c) {
      const double factor = LobeFactor(model, lobes, scalars, samples, c, diffuse[c]);
      scalars[placed.first + static_cast<std::size_t>(c)] =
          std::clamp(std::isfinite(factor) ? factor : 1.0, kFaint, placed.parameter->upper);
    }
  }
  return scalars;
}

// The scalars of `count` starts: lobes from narrow to wide, a second lobe wider than the first. The
// diffuse albedo is that of the material's darker samples; lobes reflect what they must to have
// the brightness of the brightest ones.
std::vector<std::vector<double>> AnalyticStarts(const AnalyticModel& model, int lobes,
                                                std::span<const BrdfSample> samples, int count) {
  std::vector<std::vector<double>> starts;
  for (int k = 0; k < count; ++k) {
    starts.push_back(StartAt(model, lobes, samples, (k + 0.5) / count));
  }
  return starts;
}

// The scalars of one lobe followed by those of a second one, wider and so faint that it changes
// next to nothing.
std::vector<double> WithFaintLobe(const AnalyticModel& model, std::vector<double> scalars) {
  for (const ModelParameter& parameter : model.lobe) {
    const double value = parameter.role == FitRole::kScale   ? kFaint
                         : parameter.role == FitRole::kWidth ? WidthAt(parameter, kWidthOfSecond)
                                                             : parameter.initial;
    scalars.insert(scalars.end(), static_cast<std::size_t>(parameter.size), value);
  }
  return scalars;
}

// A point that a stage reached.
struct Candidate : AnalyticFitSummary {
  std::vector<double> numbers;
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
    candidate->final_cost = summary.IsSolutionUsable() && std::isfinite(summary.final_cost)
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
void RunAll(const AnalyticFitter& fitter, const Stage& stage, std::vector<Candidate>* candidates) {
  ParallelFor(candidates->size(), [&](std::size_t k) { fitter.Run(stage, &(*candidates)[k]); });
  std::stable_sort(
      candidates->begin(), candidates->end(),
      [](const Candidate& a, const Candidate& b) { return a.final_cost < b.final_cost; });
  if (!std::isfinite(candidates->front().final_cost)) {
    Fail("no start of the fit has a finite cost: ", candidates->front().message);
  }
}

// Runs the starts and the best of them to the end. at_hand: candidates that skip the first stage.
Candidate FitLobes(const AnalyticFitter& fitter, const AnalyticFitOptions& options,
                   const std::vector<std::vector<double>>& starts,
                   std::span<const BrdfSample> samples, std::vector<Candidate> at_hand) {
  std::vector<Candidate> candidates;
  for (const std::vector<double>& scalars : starts) {
    candidates.emplace_back();
    candidates.back().numbers = fitter.parameters().FromScalars(scalars);
  }
  const double first_scale = std::max(kFirstLossScale, options.loss_scale);
  const auto first = samples.first(std::min(samples.size(), options.first_samples));
  RunAll(fitter, {first, first_scale, kFirstIterations, 1e-4}, &candidates);
  candidates.resize(std::min(candidates.size(), kMaxFinalists));
  candidates.insert(candidates.end(), at_hand.begin(), at_hand.end());
  RunAll(fitter, {samples, options.loss_scale, options.max_iterations, options.function_tolerance},
         &candidates);
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
  std::vector<Candidate> at_hand;
  std::vector<double> scalars;
  Candidate best;
  int used = 0;
  for (int n = std::min(lobes, 1); n <= lobes; ++n) {
    const AnalyticFitter fitter(model, n, isotropic);
    if (n == 2) {  // the fit of one lobe, with a second one that is hardly there
      at_hand.push_back(best);
      at_hand[0].numbers = fitter.parameters().FromScalars(WithFaintLobe(model, scalars));
    }
    const auto starts = AnalyticStarts(model, n, first, options.starts);
    Candidate fit;
    WithThreads(options.threads,
                [&] { fit = FitLobes(fitter, options, starts, samples, at_hand); });
    const double worth = (1.0 - options.lobe_gain) * best.final_cost;
    if (n == 2 && options.lobe_gain > 0.0 && !(fit.final_cost < worth)) break;
    best = std::move(fit);
    used = n;
    scalars = fitter.parameters().ToBoundedScalars(best.numbers);
  }
  best.seconds = timer.Seconds();
  return {AnalyticBrdf(model, used, scalars), best};
}

}  // namespace pbnbrdf
