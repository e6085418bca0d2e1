#include "pbnbrdf/metrics/lpips.h"

#include <cmath>
#include <limits>

#include "metrics/lpips_layers.h"
#include "metrics/planes.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// Mean and deviation of the colours, in [-1, 1], of the images that AlexNet learned from.
constexpr double kShift[3] = {-0.030, -0.088, -0.188};
constexpr double kScale[3] = {0.458, 0.448, 0.450};

// What the norm of the features is kept from 0 by.
constexpr double kEpsilon = 1e-10;

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
  if (image.width >= kLpipsSmallestSide && image.height >= kLpipsSmallestSide) return;
  Fail(name, ": ", image.width, " x ", image.height, " pixels; LPIPS needs at least ",
       kLpipsSmallestSide, " x ", kLpipsSmallestSide);
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
