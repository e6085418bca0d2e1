// How a fit ends with no directional albedo above 1, at any incident direction.
//
// From round to round the strata of the energy term follow the albedos (energy_constraints.h). What is left in the
// end is removed exactly.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/pi.h"
#include "base/timer.h"
#include "pbnbrdf/brdf/albedo.h"
#include "solve/energy_constraints.h"
#include "solve/energy_correction.h"
#include "solve/training.h"

namespace pbnbrdf {
namespace {

// Found on bright metals and on materials scaled to an albedo of 0.99 to 1 (experiments/ablation).
constexpr int kMaxRounds = 24, kRoundIterations = 12, kHastyIterations = 4;
constexpr double kSmallCorrection = 0.05;   // of the mean absolute log error
constexpr double kClearlyConserved = 0.99;  // a largest albedo that needs no finer check
constexpr double kMinCost = 1e-7;           // of the other terms, for the weight of this one
constexpr double kWeightGrowth = 10.0, kOverBalance = 30.0;
// Kept of the time for the albedos after the last stage and for the correction: in profiles by kRoundGrid, and, where
// energy was made, this part.
constexpr double kReserveProfiles = 3.0, kCorrectionPart = 0.15;
constexpr double kRoundFall = 0.9;  // of what the largest albedo is above 1, if a round gets on

// What lowering all of log(1 + f) takes if the largest directional albedo is so much; LowerToConserve takes
// less.
double CorrectionOf(double max_albedo) {
  return std::log((std::max(max_albedo, kTargetAlbedo) + kPi) / (kTargetAlbedo + kPi));
}

// The weight with which the energy term costs as much as all other terms; 0 where its cost isn't finite.
double BalancedWeight(const std::vector<EnergyStratum>& strata, Training* training) {
  Objective& validation = training->validation();
  validation.SetEnergy(0.0, {});
  const double rest = validation.Cost(training->weights().data());
  validation.SetEnergy(1.0, strata);
  const double all = validation.Cost(training->weights().data());
  if (!std::isfinite(all)) return 0.0;
  return all > rest ? std::max(rest, kMinCost) / (all - rest) : 1.0;
}

// The term's weight starts where the term costs as much as the rest, and grows from round to round
// until what remains above 1 is small. It is kept from outweighing the rest by more than it must:
// otherwise a fit gives up whole lobes.
//
// A fit that the clock has cut short takes short rounds and larger steps of the weight.
void RunRounds(double weight, EnergyConstraints* constraints, Training* training) {
  FitSummary& summary = training->summary();
  const Termination ended = summary.termination;
  const std::string message = summary.message;
  const bool in_haste = ended == Termination::kMaxSeconds;
  const int iterations = in_haste ? kHastyIterations : kRoundIterations;
  EnergySummary& energy = summary.energy;
  double max_over_balance = in_haste ? kOverBalance : 1.0;
  const int last = summary.iterations + training->options().schedule.max_iterations;
  while (energy.rounds < kMaxRounds && summary.iterations < last && training->MayContinue()) {
    const double error = training->ValidationError();
    if (CorrectionOf(energy.max_albedo) <= kSmallCorrection * error) break;
    constraints->Exchange();
    const double grown = energy.rounds > 0 ? kWeightGrowth : 1.0;
    weight = std::min(weight * grown,
                      max_over_balance * BalancedWeight(constraints->strata(), training));
    training->SetEnergy(weight, constraints->strata());
    const std::vector<double> before = training->weights();
    RunStages(training,
              std::min(iterations * training->solver().traits.pace, last - summary.iterations));
    const double excess = energy.max_albedo - 1.0;
    energy.max_albedo = constraints->Measure(training->Network());
    const bool fell = energy.max_albedo - 1.0 < kRoundFall * excess;
    max_over_balance = fell ? kOverBalance : kWeightGrowth * max_over_balance;
    energy.strata = constraints->strata().size();
    ++energy.rounds;
    if (training->weights() == before) break;  // nor would a larger weight find a step
  }
  if (!in_haste) return;
  summary.termination = ended;
  summary.message = message;
}

// A network that conserved energy when the clock stopped its fit.
struct Conserving {
  std::vector<double> weights;  // none if there isn't one
  double max_albedo = 0.0;
};

// With the stages that the clock has cut short, the energy term not being needed so far.
void GoOn(EnergyConstraints* constraints, Training* training) {
  FitSummary& summary = training->summary();
  if (!training->MayContinue()) return;
  const int left = training->options().schedule.max_iterations - summary.iterations;
  RunStagesOfAllWidths(training, std::max(left, 0));
  summary.energy.max_albedo = constraints->Measure(training->Network());
}

// Goes back where the correction took more than the fit has gained since.
void TakeBetter(const Conserving& before, Training* training) {
  Objective& validation = training->validation();
  const double error = validation.MeanAbsLogError(training->weights().data());
  if (error <= validation.MeanAbsLogError(before.weights.data())) return;
  training->weights() = before.weights;
  EnergySummary& energy = training->summary().energy;
  energy.max_albedo = before.max_albedo;
  energy.correction = 0.0;
  energy.profile.clear();
}

}  // namespace

void ConserveEnergy(const FitProblem& problem, Training* training) {
  EnergySummary& energy = training->summary().energy;
  EnergyConstraints constraints(problem);
  const Timer timer;
  energy.first_max_albedo = energy.max_albedo = constraints.Measure(training->Network());
  const double seconds = timer.Seconds();
  Conserving before;
  if (!training->solver().traits.is_stochastic) {
    if (training->summary().termination == Termination::kMaxSeconds &&
        energy.max_albedo < kClearlyConserved) {
      before = {training->weights(), energy.max_albedo};
      training->LimitTo(1.0, kReserveProfiles * seconds);
      GoOn(&constraints, training);
    }
    training->LimitTo(1.0 - kCorrectionPart, kReserveProfiles * seconds);
    RunRounds(problem.terms.EnergyWeight(), &constraints, training);
    training->LimitTo(1.0);
  }
  if (energy.max_albedo < kClearlyConserved || !training->options().certify_energy) return;
  Correction correction = LowerToConserve(
      training->shape(), [training] { return training->MayContinue(); }, &training->weights());
  energy.correction = correction.change;
  energy.max_albedo = correction.max_albedo;
  energy.profile = std::move(correction.profile);
  if (!before.weights.empty()) TakeBetter(before, training);
}

}  // namespace pbnbrdf
