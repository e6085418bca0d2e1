// small_problem.h: a problem that is solved in a moment, and how good a solution is.
#pragma once

#include "brdf/direction_pairs.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// Without an energy term.
inline FitProblem SmallProblem() {
  FitProblem problem;
  problem.network.hidden = {6};
  problem.sampling.samples = 500;
  problem.terms.SetWeight("energy", 0.0);
  return problem;
}

// Of log(1 + f), at random directions.
inline double MeanAbsDifference(const Brdf& a, const Brdf& b) {
  const std::vector<DirectionPair> pairs = RandomPairs(2000, /*seed=*/21);
  std::vector<Rgb> values_a(pairs.size()), values_b(pairs.size());
  a.Evaluate(pairs, values_a);
  b.Evaluate(pairs, values_b);
  double sum = 0.0;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    for (int c = 0; c < 3; ++c) {
      sum += std::abs(std::log1p(values_a[n][c]) - std::log1p(values_b[n][c]));
    }
  }
  return sum / (3.0 * static_cast<double>(pairs.size()));
}

}  // namespace pbnbrdf
