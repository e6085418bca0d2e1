#include "pbnbrdf/solve/fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "pbnbrdf/base/error.h"
#include "solve/fit_fields.h"
#include "solve/solver.h"
#include "solve/training.h"

namespace pbnbrdf {
namespace {

// Of the time, for the stages without the energy term, so that some is left for those with it. What these don't
// need goes to more of the former.
constexpr double kFirstPart = 0.7;

// The energy term waits until the rest is fitted: from random weights its square outweighs all else
// by orders of magnitude and leads astray, and most materials never need it.
Fit Solve(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  Training training(material, problem, options);
  training.Start();
  if (options.schedule.starts > 1) RunStarts(&training);
  const bool conserves = problem.terms.EnergyWeight() > 0.0;
  if (conserves && !training.solver().traits.is_stochastic) training.LimitTo(kFirstPart);
  RunStagesOfAllWidths(&training, options.schedule.max_iterations);
  training.LimitTo(1.0);
  if (conserves) ConserveEnergy(problem, &training);
  training.Finish();
  return {training.Network(), problem, training.summary()};
}

void CheckInitialWeights(const FitProblem& problem, const FitOptions& options) {
  if (options.initial_weights.empty()) return;
  const NetworkShape shape = problem.Shape();
  const std::size_t size = options.initial_weights.size();
  if (options.schedule.starts > 1) Fail("starts: there is but one from given weights");
  if (size != static_cast<std::size_t>(shape.num_weights())) {
    Fail("initial_weights: ", size, " numbers, a ", shape.Description(), " network has ",
         shape.num_weights());
  }
  for (double weight : options.initial_weights) {
    if (!std::isfinite(weight)) Fail("initial_weights: one isn't finite");
  }
}

void CheckMaterial(const Brdf& material, const FitProblem& problem) {
  if (material.IsIsotropic() && !IsIsotropic(*problem.network.encoding)) {
    Fail("encoding: ", NameOf(kEncodings, *problem.network.encoding),
         " is for anisotropic materials; an isotropic one has samples at phi_h = 0 only");
  }
  if (problem.network.channels < material.NumChannels()) {
    Fail("channels: the material has ", material.NumChannels(), ", the network's ",
         problem.network.channels, " would be a guess");
  }
}

}  // namespace

void ValidateFit(const FitProblem& problem, const FitOptions& options) {
  problem.Validate();
  FitOptions copy = options;
  OptionFields(&copy).Check();
  const auto& [name, help, traits, minimize] = FindSolver(options.solver);
  const int weights = problem.Shape().num_weights();
  if (traits.wide_solver.empty() && traits.max_weights > 0 && weights > traits.max_weights) {
    Fail("hidden: makes ", weights, " weights; ", name, " takes at most ", traits.max_weights,
         ", as its memory grows with their square");
  }
  if (traits.needs_squares && problem.terms.loss == Loss::kAbsolute) {
    Fail("loss: absolute isn't a sum of squares; it takes --solver=ceres_lbfgs or adam");
  }
  if (traits.is_stochastic && options.schedule.starts > 1)
    Fail("starts: ", name, " takes one only");
  if (options.threads < 0) Fail("threads = ", options.threads, "; must be >= 0");
  CheckInitialWeights(problem, options);
}

Fit FitBrdf(const Brdf& material, const FitProblem& problem, const FitOptions& options) {
  const FitProblem settled = problem.For(material);
  ValidateFit(settled, options);
  CheckMaterial(material, settled);
  std::optional<Fit> fit;
  WithThreads(options.threads, [&] { fit = Solve(material, settled, options); });
  return *std::move(fit);
}

}  // namespace pbnbrdf
