#include "solve/energy_rounds.h"

#include <algorithm>
#include <cmath>

#include "solve/energy_constraints.h"
#include "solve/stages.h"

namespace pbnbrdf {
namespace {

// Found on bright metals and on materials scaled to an albedo of 0.99 to 1 (experiments/ablation).
constexpr int kMaxRounds = 24, kRoundIterations = 40;
constexpr double kSmallCorrection = 0.05;   // of the mean absolute log error
constexpr double kClearlyConserved = 0.99;  // a largest albedo that needs no finer check
constexpr double kMinCost = 1e-7;           // of the other terms, for the weight of this one
constexpr double kWeightGrowth = 10.0, kOverBalance = 30.0;
constexpr double kRoundFall = 0.9;  // of what the largest albedo is above 1, if a round gets on

// With which the energy term costs as much as all else; 0 where its cost isn't finite.
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
void RunRounds(double weight, EnergyConstraints* constraints, Training* training) {
  FitSummary& summary = training->summary();
  EnergySummary& energy = summary.energy;
  double max_over_balance = 1.0;
  const int last = summary.iterations + training->options().schedule.max_iterations;
  while (energy.rounds < kMaxRounds && summary.iterations < last && training->MayContinue()) {
    const double error = training->validation().MeanAbsLogError(training->weights().data());
    if (CorrectionOf(energy.max_albedo) <= kSmallCorrection * error) break;
    constraints->Exchange();
    const double grown = energy.rounds > 0 ? kWeightGrowth : 1.0;
    weight = std::min(weight * grown,
                      max_over_balance * BalancedWeight(constraints->strata(), training));
    training->SetEnergy(weight, constraints->strata());
    RunStages(training, std::min(kRoundIterations * training->solver().traits.pace,
                                 last - summary.iterations));
    const double excess = energy.max_albedo - 1.0;
    energy.max_albedo = constraints->Measure(training->weights());
    const bool fell = energy.max_albedo - 1.0 < kRoundFall * excess;
    max_over_balance = fell ? kOverBalance : kWeightGrowth * max_over_balance;
    energy.strata = constraints->strata().size();
    ++energy.rounds;
  }
}

}  // namespace

void ConserveEnergy(const FitProblem& problem, Training* training) {
  EnergySummary& energy = training->summary().energy;
  EnergyConstraints constraints(problem);
  energy.first_max_albedo = energy.max_albedo = constraints.Measure(training->weights());
  if (!training->solver().traits.is_stochastic) {
    RunRounds(problem.terms.EnergyWeight(), &constraints, training);
  }
  if (energy.max_albedo < kClearlyConserved || !training->options().certify_energy) return;
  const Correction correction = LowerToConserve(problem.Shape(), &training->weights());
  energy.correction = correction.lowered;
  energy.max_albedo = correction.max_albedo;
}

}  // namespace pbnbrdf
