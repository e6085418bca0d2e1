// even_pairs.h: points and pairs of directions that fill their domain evenly.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// The n-th point of the unit cube, n = 1, 2, ..., by the additive recurrence of the three-dimensional golden ratio.
std::array<double, 3> EvenPoint(int n);

// At angles (theta_h, theta_d, phi_d) as even as those of held-out samples; both cosines are above smallest_cosine.
std::vector<DirectionPair> EvenPairs(std::size_t count, double smallest_cosine = 0.0);

}  // namespace pbnbrdf
