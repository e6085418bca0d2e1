// solver.h: what a solver is given and gives back, and the table of all solvers. A new one is a function
// like MinimizeLm (lm.cc) and a line in solver.cc.
#pragma once

#include <limits>
#include <span>
#include <string_view>

#include "pbnbrdf/solve/fit.h"
#include "problem/encoded_samples.h"

namespace pbnbrdf {

// The first trust region's radius in all Levenberg-Marquardt solvers. From random weights steps of larger
// ones are rejected several times over.
inline constexpr double kFirstTrustRegionRadius = 10.0;

// What a stage minimises: the objective, and what it was made of.
struct StageInput {
  const FitProblem& problem;
  const FitOptions& options;
  const EncodedSamples& samples;
  std::span<const EnergyStratum> strata;
  Objective* objective;
};

struct StageOptions {
  int max_iterations = 0;
  std::size_t curvature_samples = std::numeric_limits<std::size_t>::max();  // fit.h
  double function_tolerance = 0.0;  // stop when |cost change| < function_tolerance * cost
  // Of Levenberg-Marquardt's trust region. A later stage starts with that of the stage before: with the
  // first one it would take a dozen iterations to regain it.
  double first_radius = kFirstTrustRegionRadius;
  std::function<double()> seconds_left;
  // Called after each iteration, the weights being the best so far; false stops.
  std::function<bool(int iteration, double cost)> on_iteration;
};

struct StageResult {
  double cost = 0.0;  // infinite if it wasn't finite even at the start
  int iterations = 0;
  // Of the iterations of Levenberg-Marquardt: those for which no step could be computed, as the
  // damped J'J didn't factor or something wasn't finite, and those whose step was too poor to take.
  int failed_factorizations = 0;
  int rejected_steps = 0;
  double last_radius = kFirstTrustRegionRadius;  // of Levenberg-Marquardt's trust region
  Termination termination = Termination::kConverged;
  std::string message;  // why it stopped, with the numbers
};

// One minimisation. weights: where to start, and on return and in callbacks the best found.
using Minimizer = StageResult(const StageInput& input, const StageOptions& options,
                              std::vector<double>* weights);
Minimizer MinimizeLm, MinimizeCeresLm, MinimizeCeresLbfgs, MinimizeAdam, MinimizeAutodiff;

struct SolverTraits {
  bool needs_squares = true;  // takes a sum of squares: not Loss::kAbsolute
  // Draws minibatches of Loss::kAbsolute: all samples and all terms from the start, one start.
  bool is_stochastic = false;
  bool splits_curvature = false;  // sums J'J over a part of the samples (StageOptions)
  int max_weights = 0;            // whose square it holds in memory; 0: any number
  // Networks start narrow (ScheduleOptions::first_weights), and go to the solver of this name when they have more
  // than max_weights; "": it takes no wider ones.
  std::string_view wide_solver = "";
  int pace = 1;  // iterations that do as much as one of Levenberg-Marquardt
};

struct Solver {
  std::string_view name, help;
  SolverTraits traits;
  Minimizer* minimize;
};

std::span<const Solver> Solvers();

// Throws Error, naming those that there are, if there is none of that name.
const Solver& FindSolver(std::string_view name);

}  // namespace pbnbrdf
