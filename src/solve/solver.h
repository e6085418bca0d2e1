// solver.h: what every solver is, in one table. A new one is a function like MinimizeLm (lm.h) and a line
// in solver.cc.
#pragma once

#include <span>
#include <string_view>

#include "problem/encoded_samples.h"
#include "solve/stage.h"

namespace pbnbrdf {

struct SolverTraits {
  bool needs_squares = true;  // takes a sum of squares: not Loss::kAbsolute
  bool is_stochastic =
      false;  // draws minibatches of Loss::kAbsolute: all samples and all terms from the
              // start, one start
  bool splits_curvature = false;  // sums J'J over a part of the samples (StageOptions)
  int max_weights = 0;            // whose square it holds in memory; 0: any number
  int pace = 1;                   // iterations that do as much as one of Levenberg-Marquardt
};

// What a stage minimises: the objective, and what it was made of.
struct StageInput {
  const FitProblem& problem;
  const FitOptions& options;
  const EncodedSamples& samples;
  std::span<const EnergyStratum> strata;
  Objective* objective;
};

struct Solver {
  std::string_view name, help;
  SolverTraits traits;
  // weights: where to start, and on return and in callbacks the best found.
  StageResult (*minimize)(const StageInput& input, const StageOptions& options,
                          std::vector<double>* weights);
};

std::span<const Solver> Solvers();

// Throws Error, naming those that there are, if there is none of that name.
const Solver& FindSolver(std::string_view name);

}  // namespace pbnbrdf
