// lpips_layers.h: what the layers of LPIPS' network do to their input.
#pragma once

#include <cstddef>
#include <vector>

#include "pbnbrdf/metrics/lpips.h"

namespace pbnbrdf {

// height x width x channels, rows from the top.
struct FeatureMap {
  FeatureMap(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        values(std::size_t(w) * std::size_t(h) * std::size_t(c)) {}

  double* at(int x, int y) { return &values[Offset(x, y)]; }
  const double* at(int x, int y) const { return &values[Offset(x, y)]; }

  int width, height, channels;
  std::vector<double> values;

 private:
  std::size_t Offset(int x, int y) const {
    return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
  }
};

// The largest values of the windows of 3 x 3 that lie inside of the map, at every other position; NaN
// may get lost. At least 3 x 3.
FeatureMap MaxPool(const FeatureMap& map);

// max(0, bias + convolution), NaN where that is NaN: (n + 2 padding - kernel) / stride + 1 positions,
// rounded down, for n, which are at least 1. The map has shape.inputs channels.
FeatureMap Convolve(const FeatureMap& map, const LpipsLayerShape& shape, const LpipsLayer& layer);

}  // namespace pbnbrdf
