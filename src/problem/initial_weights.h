// initial_weights.h: random weights that a fit starts from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// Where a fit to `samples` starts: shape.num_weights() numbers.
std::vector<double> InitialWeights(const NetworkShape& shape, std::span<const BrdfSample> samples,
                                   std::uint64_t seed,
                                   Initialization initialization = Initialization::kGlorot);

}  // namespace pbnbrdf
