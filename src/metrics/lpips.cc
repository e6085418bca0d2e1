#include "pbnbrdf/metrics/lpips.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/products.h"
#include "metrics/planes.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Mean and deviation of the colours, in [-1, 1], of the images that AlexNet learned from.
constexpr double kShift[3] = {-0.030, -0.088, -0.188};
constexpr double kScale[3] = {0.458, 0.448, 0.450};

// Added to the norm of the features, which may be 0.
constexpr double kEpsilon = 1e-10;

constexpr int kPoolWindow = 3, kPoolStride = 2;

// Each convolution is a product of matrices: patches of the input, one a row, times the kernels. The
// patches of a tile of positions stay in the cache while the kernels go by, block by block. Both
// are the same whatever the number of threads, and so is each sum.
constexpr std::size_t kTile = 32;
constexpr int kUnitBlock = 16;

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

// The largest values of the windows of 3 x 3 that lie inside of the map, at every other position; NaN
// may get lost. At least 3 x 3.
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

// max(0, bias + convolution), NaN where that is NaN: (n + 2 padding - kernel) / stride + 1 positions,
// rounded down, for n, which are at least 1. The map has shape.inputs channels.
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

FeatureMap NetworkInput(const Image& image) {
  FeatureMap input(image.width, image.height, 3);
  for (std::size_t i = 0; i < input.values.size(); ++i) {
    input.values[i] = (2.0 * double(image.rgb[i]) - 1.0 - kShift[i % 3]) / kScale[i % 3];
  }
  return input;
}

FeatureMap NextFeatures(const FeatureMap& map, std::size_t layer, const LpipsWeights& weights) {
  const LpipsLayerShape& shape = kLpipsLayers[layer];
  return Convolve(shape.pooled ? MaxPool(map) : map, shape, weights[layer]);
}

// What the features at a position are divided by to be a unit vector; NaN if that is beyond double.
double Norm(const double* features, int channels) {
  double sum = 0.0;
  for (int c = 0; c < channels; ++c) sum += features[c] * features[c];
  if (std::isinf(sum)) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(sum) + kEpsilon;
}

double MeanDistance(const FeatureMap& x, const FeatureMap& y, const std::vector<double>& head) {
  const double sum = SumRows(x.height, [&](int row) {
    double row_sum = 0.0;
    for (int column = 0; column < x.width; ++column) {
      const double *a = x.at(column, row), *b = y.at(column, row);
      const double a_norm = Norm(a, x.channels), b_norm = Norm(b, y.channels);
      for (int c = 0; c < x.channels; ++c) {
        const double difference = a[c] / a_norm - b[c] / b_norm;
        row_sum += head[std::size_t(c)] * difference * difference;
      }
    }
    return row_sum;
  });
  return sum / (double(x.width) * double(x.height));
}

}  // namespace

void CheckLargeEnoughForLpips(const Image& image, const std::string& name) {
  if (image.width >= kMinLpipsSide && image.height >= kMinLpipsSide) return;
  Fail(name, ": ", image.width, " x ", image.height, " pixels; LPIPS needs at least ",
       kMinLpipsSide, " x ", kMinLpipsSide);
}

double Lpips(const Image& reference, const Image& test, const LpipsWeights& weights) {
  CheckLargeEnoughForLpips(reference, "the reference");
  CheckLargeEnoughForLpips(test, "the test image");
  FeatureMap x = NetworkInput(reference), y = NetworkInput(test);
  double distance = 0.0;
  for (std::size_t layer = 0; layer < kLpipsLayers.size(); ++layer) {
    x = NextFeatures(x, layer, weights);
    y = NextFeatures(y, layer, weights);
    distance += MeanDistance(x, y, weights[layer].head);
  }
  if (!std::isfinite(distance)) Fail("LPIPS isn't finite: its network's weights are too large");
  return distance;
}

}  // namespace pbnbrdf
