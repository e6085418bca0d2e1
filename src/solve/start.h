// start.h: weights that a fit can start from.
#pragma once

#include <vector>

#include "pbnbrdf/problem/objective.h"
#include "problem/encoded_samples.h"

namespace pbnbrdf {

// That tell whether weights are a start: what `objective` below should hold, or all if there are fewer.
inline constexpr std::size_t kStartSamples = 1024;

// Throws Error if a fit can't go on from weights that were given: the cost or its gradient isn't
// finite; or the gradient is 0 and the cost isn't; or the network is constant and stays so, no weight
// of its first layer having a gradient, and the material isn't constant.
void CheckStart(Objective* objective, const EncodedSamples& samples,
                const std::vector<double>& weights);

struct RandomStart {
  std::vector<double> weights;
  int restarts = 0;  // weights drawn before these that wouldn't do
};

// Random weights, others for each index: the first of a few that a fit can go on from. Those of a
// constant network have to do if there are no others. Throws Error if there are none.
RandomStart DrawStart(const FitProblem& problem, Objective* objective,
                      const EncodedSamples& samples, int index);

}  // namespace pbnbrdf
