// stage.h: what every solver is given and gives back: one minimisation, from weights to weights.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf {

// Of all Levenberg-Marquardt solvers. From random weights larger ones are refused several times over.
inline constexpr double kFirstTrustRegionRadius = 10.0;

struct StageOptions {
  int max_iterations = 0;
  std::size_t curvature_samples = std::numeric_limits<std::size_t>::max();  // fit.h
  double function_tolerance = 0.0;  // stop when |cost change| < function_tolerance * cost
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
  Termination termination = Termination::kConverged;
  std::string message;  // why it stopped, with the numbers
};

}  // namespace pbnbrdf
