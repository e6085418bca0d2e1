// widening.h: wider networks of the same function, for fits that begin with a narrow one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// Hidden layers in the proportions of the shape's own, as wide as they can be with at most so many weights: at
// least a unit each, and no wider than the shape's.
std::vector<int> NarrowedHidden(const NetworkShape& shape, std::size_t weights);

// The weights of a `wide` network that computes what the narrow one does: the first units of a layer are the narrow
// network's, and take nothing from the others. All that is left free stays as in `weights`, which are random ones.
std::vector<double> Widen(const NetworkShape& narrow, std::span<const double> narrow_weights,
                          const NetworkShape& wide, std::vector<double> weights);

}  // namespace pbnbrdf
