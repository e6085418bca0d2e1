#include "solve/widening.h"

#include <algorithm>
#include <cmath>

namespace pbnbrdf {
namespace {

// The shape with hidden layers of this part of their width.
NetworkShape Scaled(const NetworkShape& shape, double part) {
  std::vector<int> hidden = shape.hidden();
  for (int& size : hidden) size = std::max(1, static_cast<int>(std::floor(part * size)));
  return NetworkShape(shape.encoding(), hidden, shape.activation(), shape.num_outputs());
}

}  // namespace

std::vector<int> NarrowedHidden(const NetworkShape& shape, std::size_t weights) {
  const std::vector<int> hidden = shape.hidden();
  const int widest = *std::max_element(hidden.begin(), hidden.end());
  for (int width = widest; width > 1; --width) {
    const NetworkShape narrow = Scaled(shape, static_cast<double>(width) / widest);
    if (static_cast<std::size_t>(narrow.num_weights()) <= weights) return narrow.hidden();
  }
  return std::vector<int>(hidden.size(), 1);
}

std::vector<double> Widen(const NetworkShape& narrow, std::span<const double> narrow_weights,
                          const NetworkShape& wide, std::vector<double> weights) {
  for (int layer = 0; layer < narrow.num_layers(); ++layer) {
    const int in = narrow.in(layer), wide_in = wide.in(layer);
    const double* from = narrow_weights.data() + narrow.offset(layer);
    double* to = weights.data() + wide.offset(layer);
    for (int o = 0; o < narrow.out(layer); ++o, from += in + 1, to += wide_in + 1) {
      std::copy_n(from, in, to);
      std::fill(to + in, to + wide_in, 0.0);
      to[wide_in] = from[in];
    }
  }
  return weights;
}

}  // namespace pbnbrdf
