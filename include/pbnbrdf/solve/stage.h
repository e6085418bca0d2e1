// stage.h: what every solver is given and gives back: one minimisation, from weights to weights.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

enum class Termination { kConverged, kMaxIterations, kMaxSeconds, kInterrupted };

inline constexpr NameTable<Termination, 4> kTerminations = {
    {{"converged", Termination::kConverged},
     {"max_iterations", Termination::kMaxIterations},
     {"max_seconds", Termination::kMaxSeconds},
     {"interrupted", Termination::kInterrupted}}};

// Of both Levenberg-Marquardt solvers. From random weights larger ones are refused several times over.
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
  double cost = 0.0;
  int iterations = 0;
  Termination termination = Termination::kConverged;
  std::string message;  // why it stopped, with the numbers
};

}  // namespace pbnbrdf
