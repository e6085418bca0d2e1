#include "solve/training.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problem/fit_target.h"
#include "solve/start.h"

namespace pbnbrdf {
namespace {

// Samples of the training distribution that no solver sees. Their cost differs from that of all samples
// by a few hundredths.
constexpr std::size_t kValidationSamples = 4096;
constexpr std::uint64_t kValidationSeed = 0x9e3779b97f4a7c15;

constexpr std::size_t kHeldOutSamples = 32768;
constexpr std::uint64_t kHeldOutSeed = 1;

constexpr std::size_t kStochasticCostSamples = 16384;  // whose cost says how minibatches get on
constexpr std::size_t kCurvatureGrowth = 4;
constexpr double kRoundingShare = 0.01;  // of the cost

FitProblem WithoutEnergy(FitProblem problem) {
  problem.terms.SetWeight("energy", 0.0);
  return problem;
}

FitProblem FirstProblem(FitProblem problem, const Solver& solver) {
  if (!solver.traits.is_stochastic) return WithoutEnergy(problem);
  problem.terms.loss = Loss::kAbsolute;
  return problem;
}

void DrawInto(SampleStream* stream, std::size_t count, EncodedSamples* samples) {
  std::vector<BrdfSample> drawn;
  stream->Draw(count, &drawn);
  samples->Add(drawn);
}

}  // namespace

Training::Training(const Brdf& material, const FitProblem& problem, const FitOptions& options)
    : options_(options),
      solver_(FindSolver(options.solver)),
      problem_(FirstProblem(problem, solver_)),
      target_(FitTarget(material, *problem.network.encoding)),
      stream_(*target_, SampleSet::kTraining, problem.sampling.Angles(), problem.sampling.seed),
      max_samples_(std::min<std::size_t>(problem.sampling.samples, stream_.most())),
      samples_(*problem.network.encoding),
      validation_samples_(*problem.network.encoding,
                          DrawSamples(*target_, SampleSet::kTraining, problem.sampling.Angles(),
                                      kValidationSamples, problem.sampling.seed + kValidationSeed)),
      heldout_samples_(*problem.network.encoding),
      strata_(EqualStrata(problem)),
      curvature_samples_(options.schedule.curvature_samples),
      weights_(options.initial_weights) {
  const std::size_t first = std::min<std::size_t>(options.schedule.first_samples, max_samples_);
  DrawInto(&stream_, solver_.traits.is_stochastic ? max_samples_ : first, &samples_);
  objective_ = MakeObjective(problem_, options.precision, samples_,
                             std::min(kStartSamples, samples_.size()));
  validation_ = MakeObjective(WithoutEnergy(problem_), options.precision, validation_samples_,
                              validation_samples_.size());
  summary_.final_cost = std::numeric_limits<double>::infinity();
  if (!options.on_iteration) return;
  timer_.Exclude([&] {
    heldout_samples_.Add(HeldOutSamples(material, kHeldOutSamples, kHeldOutSeed));
    heldout_ = MakeObjective(WithoutEnergy(problem_), options.precision, heldout_samples_,
                             heldout_samples_.size());
    return true;
  });
}

void Training::Start() {
  if (weights_.empty()) {
    StartAnew(0);
  } else {
    CheckStart(objective_.get(), samples_, weights_);
  }
  objective_->Grow(solver_.traits.is_stochastic ? std::min(kStochasticCostSamples, samples_.size())
                                                : samples_.size());
}

void Training::StartAnew(int index) {
  RandomStart drawn = DrawStart(problem_, objective_.get(), samples_, index);
  weights_ = std::move(drawn.weights);
  summary_.restarts += drawn.restarts;
}

bool Training::MayContinue() const {
  return summary_.termination != Termination::kInterrupted && SecondsLeft() > 0.0;
}

double Training::SecondsLeft() const {
  return limit_ * options_.schedule.max_seconds - timer_.Seconds();
}

void Training::TakeMoreSamples() {
  const double grown = std::ceil(options_.schedule.growth * static_cast<double>(samples_.size()));
  const double wanted = std::min(grown, static_cast<double>(max_samples_));
  DrawInto(&stream_, static_cast<std::size_t>(wanted) - samples_.size(), &samples_);
  objective_->Grow(samples_.size());
}

bool Training::HasPartOfCurvature() const {
  return solver_.traits.splits_curvature && curvature_samples_ < samples_.size();
}

void Training::TakeMoreCurvature() { curvature_samples_ *= kCurvatureGrowth; }

void Training::SetEnergy(double weight, std::vector<EnergyStratum> strata) {
  strata_ = std::move(strata);
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
  stage.function_tolerance = options_.schedule.function_tolerance;
  stage.seconds_left = [this] { return SecondsLeft(); };
  stage.on_iteration = std::move(on_iteration);
  const StageResult result =
      solver_.minimize({problem_, options_, samples_, strata_, objective_.get()}, stage, &weights_);
  if (std::isfinite(result.cost)) summary_.final_cost = result.cost;
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
    progress.heldout_error = heldout_->MeanAbsLogError(weights_.data());
    return options_.on_iteration(progress);
  });
}

void Training::Finish() {
  summary_.seconds = timer_.Seconds();
  summary_.samples = samples_.size();
  summary_.energy.work = objective_->energy_work();
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
