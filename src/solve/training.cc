#include "solve/training.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pbnbrdf/base/error.h"
#include "problem/fit_target.h"
#include "problem/initial_weights.h"
#include "solve/widening.h"

namespace pbnbrdf {
namespace {

// Samples of the training distribution that no solver sees. Their cost differs from that of all samples
// by a few hundredths.
constexpr std::size_t kValidationSamples = 4096;
constexpr std::uint64_t kValidationSeed = 0x9e3779b97f4a7c15;

// For FitProgress::heldout_error.
constexpr std::size_t kHeldOutSamples = 32768;
constexpr std::uint64_t kHeldOutSeed = 1;

constexpr std::size_t kStochasticCostSamples =
    16384;                        // whose cost is watched while minibatches run
constexpr double kMinPart = 0.5;  // of the time, that a reserve leaves
// Of the last iteration's time, kept for the next one, which so ends as often before the limit as after.
constexpr double kLeadTime = 0.5;
constexpr double kRoundingShare = 0.01;  // FitSummary::precision_limited

constexpr std::size_t kStartSamples = 1024;  // on which a start is judged
constexpr int kMaxRestarts = 5;  // in a row; then the problem is at fault, not the start
constexpr std::uint64_t kIndexSeed = 0xbf58476d1ce4e5b9, kRestartSeed = 0x94d049bb133111eb,
                        kWideningSeed = 0xd6e8feb86659fd93;
constexpr double kRoundingSpread = 1e-6;  // of a constant network in single precision

// A fault of a start that others may share: the material isn't constant, but the network is and stays so,
// as with a layer of dead units.
constexpr std::string_view kStaysConstant =
    "a constant network that stays one: its first layer has no gradient";

// By more than rounding makes of a constant.
bool Varies(const std::vector<Rgb>& values) {
  return std::any_of(values.begin(), values.end(), [&](const Rgb& value) {
    for (int c = 0; c < NetworkShape::kChannels; ++c) {
      const double first = values.front()[c];
      if (std::abs(value[c] - first) > kRoundingSpread * (1.0 + first)) return true;
    }
    return false;
  });
}

// Why a fit can't go on from these weights; empty if it can.
std::string_view FaultOf(const std::vector<double>& weights, const EncodedSamples& all_samples,
                         Objective* objective) {
  const auto samples = all_samples.first(kStartSamples);
  const NetworkShape& shape = objective->shape();
  double cost = 0.0;
  std::vector<double> gradient(shape.num_weights());
  if (!objective->Gradient(weights.data(), &cost, gradient.data())) {
    return "the cost or its gradient isn't finite there";
  }
  const auto rest = gradient.begin() + shape.block_size(0);
  const auto is_zero = [](double slope) { return slope == 0.0; };
  if (cost == 0.0 || !std::all_of(gradient.begin(), rest, is_zero)) return "";
  if (std::all_of(rest, gradient.end(), is_zero))
    return "the gradient is 0 there and the cost isn't";
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> wanted, values(samples.size());
  for (const BrdfSample& sample : samples) {
    pairs.push_back(sample.pair);
    wanted.push_back(sample.value);
  }
  NeuralBrdf(shape, weights).EvaluateUnclipped(pairs, values);
  return Varies(wanted) && !Varies(values) ? kStaysConstant : "";
}

// Random weights, others for each index: the first of a few that a fit can go on from. Those of a
// constant network have to do if there are no others. Throws Error if there are none.
std::vector<double> DrawStart(const FitProblem& problem, const EncodedSamples& samples, int index,
                              Objective* objective, int* restarts) {
  std::vector<double> constant;
  for (int restart = 0; restart <= kMaxRestarts; ++restart) {
    const std::uint64_t seed = problem.sampling.seed +
                               static_cast<std::uint64_t>(index) * kIndexSeed +
                               static_cast<std::uint64_t>(restart) * kRestartSeed;
    const std::vector<double> weights =
        InitialWeights(problem.Shape(), samples.samples(), seed, problem.network.initialization);
    const std::string_view fault = FaultOf(weights, samples, objective);
    if (fault.empty()) return weights;
    if (fault == kStaysConstant && constant.empty()) constant = weights;
    if (restart < kMaxRestarts) ++*restarts;
  }
  if (!constant.empty()) return constant;
  Fail("no start: at each of ", kMaxRestarts + 1,
       " random ones the cost isn't finite or its gradient is 0");
}

FitProblem WithoutEnergy(FitProblem problem) {
  problem.terms.SetWeight("energy", 0.0);
  return problem;
}

FitProblem FirstProblem(FitProblem problem, const FitOptions& options) {
  const SolverTraits& traits = FindSolver(options.solver).traits;
  if (!traits.wide_solver.empty() && options.initial_weights.empty()) {
    problem.network.hidden = NarrowedHidden(problem.Shape(), options.schedule.first_weights);
  }
  if (!traits.is_stochastic) return WithoutEnergy(problem);
  problem.terms.loss = Loss::kAbsolute;
  return problem;
}

// The solver that is asked for, or the one that it leaves so many weights to.
const Solver& SolverFor(const FitOptions& options, const NetworkShape& shape) {
  const Solver& solver = FindSolver(options.solver);
  const bool is_wide =
      !solver.traits.wide_solver.empty() && shape.num_weights() > solver.traits.max_weights;
  return is_wide ? FindSolver(solver.traits.wide_solver) : solver;
}

void DrawInto(SampleStream* stream, std::size_t count, EncodedSamples* samples) {
  std::vector<BrdfSample> drawn;
  stream->Draw(count, &drawn);
  samples->Add(drawn);
}

}  // namespace

Training::Training(const Brdf& material, const FitProblem& problem, const FitOptions& options)
    : options_(options),
      hidden_(problem.network.hidden),
      problem_(FirstProblem(problem, options)),
      solver_(&SolverFor(options, problem_.Shape())),
      target_(FitTarget(material, *problem.network.encoding)),
      stream_(*target_, SampleSet::kTraining, problem.sampling.Angles(), problem.sampling.seed,
              options.expected),
      max_samples_(std::min<std::size_t>(problem.sampling.samples, stream_.most())),
      samples_(*problem.network.encoding),
      validation_samples_(*problem.network.encoding),
      heldout_samples_(*problem.network.encoding),
      strata_(EqualStrata(problem)),
      curvature_samples_(options.schedule.curvature_samples),
      limit_(options.schedule.max_seconds),
      weights_(options.initial_weights) {
  SampleStream validation_stream = stream_.WithSeed(problem.sampling.seed + kValidationSeed);
  DrawInto(&validation_stream, kValidationSamples, &validation_samples_);
  const std::size_t first = std::min<std::size_t>(options.schedule.first_samples, max_samples_);
  DrawInto(&stream_, solver_->traits.is_stochastic ? max_samples_ : first, &samples_);
  summary_.final_cost = std::numeric_limits<double>::infinity();
  if (options.on_iteration && options.reports_heldout_error) {
    timer_.Exclude([&] {
      heldout_samples_.Add(HeldOutSamples(material, kHeldOutSamples, kHeldOutSeed));
      return true;
    });
  }
  MakeObjectives(std::min(kStartSamples, samples_.size()));
}

void Training::MakeObjectives(std::size_t count) {
  const FitProblem unseen = WithoutEnergy(problem_);
  const Precision precision = options_.precision;
  objective_ = MakeObjective(problem_, precision, samples_, count);
  validation_ = MakeObjective(unseen, precision, validation_samples_, validation_samples_.size());
  if (heldout_samples_.size() == 0) return;
  timer_.Exclude([&] {
    heldout_ = MakeObjective(unseen, precision, heldout_samples_, heldout_samples_.size());
    return true;
  });
}

void Training::Start() {
  if (weights_.empty()) {
    StartAnew(0);
  } else if (const auto fault = FaultOf(weights_, samples_, objective_.get()); !fault.empty()) {
    Fail("initial_weights: ", fault);
  }
  objective_->Grow(solver_->traits.is_stochastic ? std::min(kStochasticCostSamples, samples_.size())
                                                 : samples_.size());
}

void Training::StartAnew(int index) {
  weights_ = DrawStart(problem_, samples_, index, objective_.get(), &summary_.restarts);
  radius_ = kFirstTrustRegionRadius;
}

bool Training::MayContinue() const {
  return summary_.termination != Termination::kInterrupted && SecondsLeft() > 0.0;
}

void Training::LimitTo(double part, double reserve) {
  const double seconds = options_.schedule.max_seconds;
  limit_ = std::min(part * seconds, std::max(seconds - reserve, kMinPart * seconds));
}

double Training::SecondsLeft() const {
  return limit_ - (options_.limits_wall_time ? wall_timer_ : timer_).Seconds();
}

void Training::TakeMoreSamples() {
  const double grown = std::ceil(options_.schedule.growth * static_cast<double>(samples_.size()));
  const double wanted = std::min(grown, static_cast<double>(max_samples_));
  DrawInto(&stream_, static_cast<std::size_t>(wanted) - samples_.size(), &samples_);
  objective_->Grow(samples_.size());
}

void Training::TakeMoreWeights() {
  const double grown = options_.schedule.growth * shape().num_weights();
  const double wanted = std::min(grown, static_cast<double>(solver_->traits.max_weights));
  FitProblem all = problem_;
  all.network.hidden = hidden_;
  const std::vector<int> hidden = NarrowedHidden(all.Shape(), static_cast<std::size_t>(wanted));
  WidenTo(hidden == problem_.network.hidden ? hidden_ : hidden);
}

void Training::WidenTo(const std::vector<int>& hidden) {
  const NetworkShape narrow = shape();
  problem_.network.hidden = hidden;
  const std::vector<double> fresh =
      InitialWeights(shape(), samples_.samples(), problem_.sampling.seed + kWideningSeed,
                     problem_.network.initialization);
  weights_ = Widen(narrow, weights_, shape(), fresh);
  solver_ = &SolverFor(options_, shape());
  curvature_samples_ = options_.schedule.curvature_samples;
  radius_ = kFirstTrustRegionRadius;
  MakeObjectives(samples_.size());
}

bool Training::HasPartOfCurvature() const {
  return solver_->traits.splits_curvature && !HasEnergy() && curvature_samples_ < samples_.size();
}

void Training::GrowCurvature(std::size_t times) {
  curvature_samples_ = times * options_.schedule.curvature_samples;
  objective_->SumCurvatureInDouble();
}

void Training::SetEnergy(double weight, std::vector<EnergyStratum> strata) {
  strata_ = std::move(strata);
  curvature_samples_ = options_.schedule.curvature_samples;
  radius_ = kFirstTrustRegionRadius;
  problem_.terms.SetWeight("energy", weight);
  for (Objective* objective : {objective_.get(), validation_.get()}) {
    objective->SetEnergy(weight, strata_);
  }
}

double Training::Minimize(int max_iterations,
                          std::function<bool(int iteration, double cost)> on_iteration) {
  objective_->SetEnergy(problem_.terms.EnergyWeight(), strata_);  // a stage begins with all strata
  StageOptions stage;
  stage.max_iterations = max_iterations;
  stage.curvature_samples = curvature_samples_;
  stage.first_radius = radius_;
  stage.function_tolerance = options_.schedule.function_tolerance;
  double last = SecondsLeft();
  stage.seconds_left = [this, last]() mutable {
    const double before = last;
    last = SecondsLeft();
    return last - kLeadTime * (before - last);
  };
  stage.on_iteration = std::move(on_iteration);
  const StageResult result = solver_->minimize(
      {problem_, options_, samples_, strata_, objective_.get()}, stage, &weights_);
  if (std::isfinite(result.cost)) summary_.final_cost = result.cost;
  radius_ = std::max(result.last_radius, kFirstTrustRegionRadius);
  summary_.iterations += result.iterations;
  summary_.failed_factorizations += result.failed_factorizations;
  summary_.rejected_steps += result.rejected_steps;
  summary_.termination = result.termination;
  summary_.message = result.message;
  return result.cost;
}

bool Training::Report(int iteration, double cost) {
  if (!options_.on_iteration) return true;
  FitProgress progress;
  progress.iteration = summary_.iterations + iteration;
  progress.cost = cost;
  progress.seconds = timer_.Seconds();
  return timer_.Exclude([&] {
    progress.heldout_error = heldout_ ? heldout_->MeanAbsLogError(weights_.data()) : 0.0;
    return options_.on_iteration(progress);
  });
}

double Training::RecordError(int iteration) {
  const double error = ValidationError();
  summary_.history.push_back({summary_.iterations + iteration, timer_.Seconds(), error});
  return error;
}

void Training::Finish() {
  summary_.energy.work = objective_->energy_work();
  if (!HasAllWeights()) WidenTo(hidden_);
  summary_.seconds = timer_.Seconds();
  summary_.samples = samples_.size();
  summary_.precision_limited = options_.precision == Precision::kSingle && !AgreesInDouble();
}

// Whether rounding plays no part in the cost of the terms over samples.
bool Training::AgreesInDouble() {
  SetEnergy(0.0, {});
  const auto exact =
      MakeObjective(problem_, Precision::kDouble, validation_samples_, validation_samples_.size());
  const double cost = exact->Cost(weights_.data());
  return std::abs(validation_->Cost(weights_.data()) - cost) <= kRoundingShare * cost;
}

}  // namespace pbnbrdf
