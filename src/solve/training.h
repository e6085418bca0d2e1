// training.h: a fit in progress: samples, objectives, weights, clock and summary; and its stages.
#pragma once

#include <memory>
#include <vector>

#include "base/timer.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/encoded_samples.h"
#include "solve/solver.h"

namespace pbnbrdf {

class Training {
 public:
  // problem: of a material (FitProblem::For). It starts without the energy term, unless the solver is
  // stochastic. material and options must outlive this.
  Training(const Brdf& material, const FitProblem& problem, const FitOptions& options);

  // Of the network as it is now.
  const Solver& solver() const { return *solver_; }
  NetworkShape shape() const { return problem_.Shape(); }
  NeuralBrdf Network() const { return {shape(), weights_}; }

  const FitOptions& options() const { return options_; }
  FitSummary& summary() { return summary_; }
  std::vector<double>& weights() { return weights_; }

  // On samples that no solver sees, and its cost and mean absolute log error at the weights.
  Objective& validation() { return *validation_; }
  double ValidationCost() { return validation_->Cost(weights_.data()); }
  double ValidationError() { return validation_->MeanAbsLogError(weights_.data()); }

  // Starts at the given weights, or at random ones. Throws Error if these lead nowhere.
  void Start();
  // At random weights, those of the index-th start.
  void StartAnew(int index);

  // From now on the clock ends the fit when this part of FitOptions::schedule.max_seconds has passed, and before
  // the last `reserve` seconds of them, unless these are most of them.
  void LimitTo(double part, double reserve = 0.0);

  // Whether neither the user nor the clock has ended the fit.
  bool MayContinue() const;

  bool HasAllSamples() const { return samples_.size() == max_samples_; }
  void TakeMoreSamples();

  // A wider network is the same function at first.
  bool HasAllWeights() const { return problem_.network.hidden == hidden_; }
  void TakeMoreWeights();

  // Whether J'J is summed over a part of the samples, and may be over more of them: not with the energy
  // term, whose rounds needn't be exact.
  bool HasPartOfCurvature() const;
  // Of how many times as many samples as at first.
  std::size_t CurvatureGrowth() const {
    return curvature_samples_ / options_.schedule.curvature_samples;
  }
  // From now on, and in double precision: the steps that it is wanted for are long.
  void GrowCurvature(std::size_t times);

  bool HasEnergy() const { return problem_.terms.EnergyWeight() > 0.0; }
  // Of the energy term, from now on.
  void SetEnergy(double weight, std::vector<EnergyStratum> strata);

  // Runs the solver, at most so many iterations, from the weights and to the best ones. Returns the cost.
  // A stage whose cost isn't finite at its start leaves that of the stage before in the summary.
  double Minimize(int max_iterations, std::function<bool(int iteration, double cost)> on_iteration);

  // Tells the user, if there is one, who may stop the fit.
  bool Report(int iteration, double cost);

  // ValidationError(), which the summary's history keeps.
  double RecordError(int iteration);

  // Completes the network, and the summary.
  void Finish();

 private:
  // Of the first `count` samples.
  void MakeObjectives(std::size_t count);
  void WidenTo(const std::vector<int>& hidden);
  double SecondsLeft() const;  // until the clock ends the fit
  bool AgreesInDouble();

  Timer timer_, wall_timer_;  // without what isn't to be counted, and all
  const FitOptions& options_;
  const std::vector<int> hidden_;  // of the network in the end
  FitProblem problem_;
  const Solver* solver_;
  std::shared_ptr<const Brdf> target_;
  SampleStream stream_;
  std::size_t max_samples_;
  EncodedSamples samples_, validation_samples_, heldout_samples_;
  std::vector<EnergyStratum> strata_;
  std::unique_ptr<Objective> objective_, validation_, heldout_;
  std::size_t curvature_samples_;
  double radius_ = kFirstTrustRegionRadius;  // of the next stage's trust region
  double limit_;                             // seconds
  std::vector<double> weights_;
  FitSummary summary_;
};

// Leaves the best of several short runs, of ScheduleOptions::starts. The first start is the training's.
void RunStarts(Training* training);

// Minimises from where the last stage ended, on the samples so far and then on more and more.
void RunStages(Training* training, int max_iterations);

// The same again for each width, up to the problem's, that there is time for.
void RunStagesOfAllWidths(Training* training, int max_iterations);

// Brings all directional albedos to at most 1: by stages with the energy term (eq. 5) and, where that isn't
// enough, by lowering the network as a whole. problem: with the energy term's weight to begin with. A fit that the
// clock has stopped, and that conserves energy, first goes on for as long as it may.
void ConserveEnergy(const FitProblem& problem, Training* training);

}  // namespace pbnbrdf
