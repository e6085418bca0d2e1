// Each convolution is a product of matrices: patches of the input, one a row, times the kernels.
#include "metrics/lpips_layers.h"

#include <algorithm>

#include "kernels/products.h"
#include "metrics/planes.h"

namespace pbnbrdf {
namespace {

constexpr int kPoolWindow = 3, kPoolStride = 2;

// The patches of a tile of positions stay in the cache while the kernels go by, block by block. Both
// are the same whatever the number of threads, and so is each sum.
constexpr std::size_t kTile = 32;
constexpr int kUnitBlock = 16;

int PatchSize(const LpipsLayerShape& shape) { return shape.inputs * shape.kernel * shape.kernel; }

int Positions(int extent, const LpipsLayerShape& shape) {
  return (extent + 2 * shape.padding - shape.kernel) / shape.stride + 1;
}

// units x kernel x kernel x inputs: a position's inputs lie side by side, as in a FeatureMap.
std::vector<double> InPatchOrder(const std::vector<double>& kernels, const LpipsLayerShape& shape) {
  const std::size_t inputs = std::size_t(shape.inputs);
  const std::size_t window = std::size_t(shape.kernel) * std::size_t(shape.kernel);
  std::vector<double> ordered(kernels.size());
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const std::size_t unit = i / (inputs * window), input = i / window % inputs, at = i % window;
    ordered[(unit * window + at) * inputs + input] = kernels[i];
  }
  return ordered;
}

// What the kernels see at (x, y) of the output: kernel x kernel x inputs. `patch` is 0, and stays so
// where it is beyond the map's edges.
void FillPatch(const FeatureMap& map, const LpipsLayerShape& shape, int x, int y, double* patch) {
  const int left = x * shape.stride - shape.padding, top = y * shape.stride - shape.padding;
  for (int row = 0; row < shape.kernel; ++row) {
    if (top + row < 0 || top + row >= map.height) continue;
    for (int column = 0; column < shape.kernel; ++column) {
      if (left + column < 0 || left + column >= map.width) continue;
      std::copy_n(map.at(left + column, top + row), map.channels,
                  patch + (row * shape.kernel + column) * map.channels);
    }
  }
}

// The output at `count` positions from the one of index `begin`, to `out`. `kernels`: in patch order.
void ConvolveTile(const FeatureMap& map, const LpipsLayerShape& shape,
                  const std::vector<double>& kernels, const std::vector<double>& biases,
                  std::size_t begin, std::size_t count, double* out) {
  const int size = PatchSize(shape), tile = static_cast<int>(count);
  const std::size_t width = std::size_t(Positions(map.width, shape));
  std::vector<double> patches(count * std::size_t(size));
  for (std::size_t i = 0; i < count; ++i) {
    FillPatch(map, shape, static_cast<int>((begin + i) % width),
              static_cast<int>((begin + i) / width), &patches[i * std::size_t(size)]);
    std::copy(biases.begin(), biases.end(), out + i * std::size_t(shape.units));
  }
  for (int unit = 0; unit < shape.units; unit += kUnitBlock) {
    kernels::AddRowProducts(
        1.0, patches.data(), tile, size, &kernels[std::size_t(unit) * std::size_t(size)],
        std::min(kUnitBlock, shape.units - unit), size, size, out + unit, shape.units);
  }
  for (double* value = out; value < out + count * std::size_t(shape.units); ++value) {
    if (*value < 0.0) *value = 0.0;
  }
}

}  // namespace

FeatureMap MaxPool(const FeatureMap& map) {
  FeatureMap pooled((map.width - kPoolWindow) / kPoolStride + 1,
                    (map.height - kPoolWindow) / kPoolStride + 1, map.channels);
  ForEachRow(pooled.height, [&](int y) {
    for (int x = 0; x < pooled.width; ++x) {
      double* to = pooled.at(x, y);
      std::copy_n(map.at(kPoolStride * x, kPoolStride * y), map.channels, to);
      for (int i = 1; i < kPoolWindow * kPoolWindow; ++i) {
        const double* from =
            map.at(kPoolStride * x + i % kPoolWindow, kPoolStride * y + i / kPoolWindow);
        for (int c = 0; c < map.channels; ++c) to[c] = std::max(to[c], from[c]);
      }
    }
  });
  return pooled;
}

FeatureMap Convolve(const FeatureMap& map, const LpipsLayerShape& shape, const LpipsLayer& layer) {
  const std::vector<double> kernels = InPatchOrder(layer.kernels, shape);
  FeatureMap out(Positions(map.width, shape), Positions(map.height, shape), shape.units);
  const std::size_t positions = std::size_t(out.width) * std::size_t(out.height);
  ForEachRow(static_cast<int>((positions + kTile - 1) / kTile), [&](int tile) {
    const std::size_t begin = std::size_t(tile) * kTile;
    ConvolveTile(map, shape, kernels, layer.biases, begin, std::min(kTile, positions - begin),
                 &out.values[begin * std::size_t(shape.units)]);
  });
  return out;
}

}  // namespace pbnbrdf
