// LPIPS against the same network in plain loops, and what it makes of equal images, features of 0 and
// input that it can't take. The package's own values: interop/image_test.py.
#include "pbnbrdf/metrics/lpips.h"

#include <tbb/global_control.h>

#include <algorithm>

#include "image/images.h"
#include "metrics/lpips_weights.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// values[channel][y][x]
using Maps = std::vector<std::vector<std::vector<double>>>;

Maps Zeros(int channels, int height, int width) {
  return Maps(std::size_t(channels),
              std::vector<std::vector<double>>(std::size_t(height),
                                               std::vector<double>(std::size_t(width))));
}

int Width(const Maps& maps) { return static_cast<int>(maps[0][0].size()); }
int Height(const Maps& maps) { return static_cast<int>(maps[0].size()); }

Maps Scaled(const Image& image) {
  const double mean[] = {-0.030, -0.088, -0.188}, deviation[] = {0.458, 0.448, 0.450};
  Maps maps = Zeros(3, image.height, image.width);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const std::size_t c = i % 3, x = i / 3 % std::size_t(image.width),
                      y = i / 3 / std::size_t(image.width);
    maps[c][y][x] = (2 * double(image.rgb[i]) - 1 - mean[c]) / deviation[c];
  }
  return maps;
}

Maps Pooled(const Maps& maps) {
  Maps pooled = Zeros(int(maps.size()), (Height(maps) - 1) / 2, (Width(maps) - 1) / 2);
  for (std::size_t c = 0; c < maps.size(); ++c) {
    for (std::size_t y = 0; y < pooled[c].size(); ++y) {
      for (std::size_t x = 0; x < pooled[c][y].size(); ++x) {
        double largest = maps[c][2 * y][2 * x];
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = 0; j < 3; ++j) {
            largest = std::max(largest, maps[c][2 * y + i][2 * x + j]);
          }
        }
        pooled[c][y][x] = largest;
      }
    }
  }
  return pooled;
}

Maps Convolved(const Maps& maps, std::size_t k, int size, int stride, int padding,
               const LpipsLayer& layer) {
  const int height = (Height(maps) + 2 * padding - size + stride) / stride;
  const int width = (Width(maps) + 2 * padding - size + stride) / stride;
  const int units = kLpipsLayers[k].units, channels = static_cast<int>(maps.size());
  Maps out = Zeros(units, height, width);
  for (int u = 0; u < units; ++u) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        double sum = layer.biases[std::size_t(u)];
        for (int c = 0; c < channels; ++c) {
          for (int i = 0; i < size; ++i) {
            for (int j = 0; j < size; ++j) {
              const int row = y * stride - padding + i, column = x * stride - padding + j;
              if (row < 0 || row >= Height(maps) || column < 0 || column >= Width(maps)) continue;
              sum += layer.kernels[std::size_t(((u * channels + c) * size + i) * size + j)] *
                     maps[std::size_t(c)][std::size_t(row)][std::size_t(column)];
            }
          }
        }
        out[std::size_t(u)][std::size_t(y)][std::size_t(x)] = std::max(0.0, sum);
      }
    }
  }
  return out;
}

std::vector<Maps> Features(const Image& image, const LpipsWeights& weights) {
  std::vector<Maps> features;
  features.push_back(Convolved(Scaled(image), 0, 11, 4, 2, weights[0]));
  features.push_back(Convolved(Pooled(features[0]), 1, 5, 1, 2, weights[1]));
  features.push_back(Convolved(Pooled(features[1]), 2, 3, 1, 1, weights[2]));
  features.push_back(Convolved(features[2], 3, 3, 1, 1, weights[3]));
  features.push_back(Convolved(features[3], 4, 3, 1, 1, weights[4]));
  return features;
}

double NormAt(const Maps& maps, std::size_t y, std::size_t x) {
  double sum = 0.0;
  for (const auto& map : maps) sum += map[y][x] * map[y][x];
  return std::sqrt(sum);
}

// What each layer adds.
std::vector<double> LayerDistances(const Image& a, const Image& b, const LpipsWeights& weights) {
  const std::vector<Maps> of_a = Features(a, weights), of_b = Features(b, weights);
  std::vector<double> distances;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const std::size_t height = of_a[k][0].size(), width = of_a[k][0][0].size();
    double sum = 0.0;
    for (std::size_t y = 0; y < height; ++y) {
      for (std::size_t x = 0; x < width; ++x) {
        const double norm_a = NormAt(of_a[k], y, x) + 1e-10, norm_b = NormAt(of_b[k], y, x) + 1e-10;
        for (std::size_t u = 0; u < of_a[k].size(); ++u) {
          sum += weights[k].head[u] *
                 std::pow(of_a[k][u][y][x] / norm_a - of_b[k][u][y][x] / norm_b, 2);
        }
      }
    }
    distances.push_back(sum / double(height * width));
  }
  return distances;
}

void ExpectPlainLoops(int width, int height, const LpipsWeights& weights) {
  SCOPED_TRACE(StrCat(width, " x ", height));
  const Image a = RandomImage(width, height, 0.0, 1.0, 1), b = RandomImage(width, height, 0, 1, 2);
  double expected = 0.0;
  for (double distance : LayerDistances(a, b, weights)) {
    EXPECT_GT(distance, 1e-6);  // each layer has its say
    expected += distance;
  }
  EXPECT_NEAR(Lpips(a, b, weights), expected, 1e-11 * expected);
}

TEST(Lpips, IsWhatPlainLoopsGive) {
  const LpipsWeights weights = RandomLpipsWeights(1);
  ExpectPlainLoops(31, 31, weights);  // 7, 3 and 1 positions a side
  ExpectPlainLoops(34, 47, weights);  // a kernel, a window don't reach the edges
  ExpectPlainLoops(83, 52, weights);  // several tiles of positions, the last of them not full
}

TEST(Lpips, KeepsNormsFrom0) {
  LpipsWeights weights = RandomLpipsWeights(2);
  for (std::size_t k = 0; k < weights.size(); ++k) {  // the others follow, but for their biases
    for (double& weight : weights[k].kernels) weight *= k == 0 ? 1e-10 : 1.0;
    for (double& bias : weights[k].biases) bias *= 1e-10;
  }
  ExpectPlainLoops(35, 33, weights);
}

TEST(Lpips, EqualImagesAre0Apart) {
  const LpipsWeights weights = RandomLpipsWeights(3);
  for (const Image& image :
       {RandomImage(64, 45, 0.0, 1.0, 1), Image(31, 40), ConstantImage(40, 31, 1.0f, 0.5f, 0.0f)}) {
    EXPECT_EQ(Lpips(image, image, weights), 0.0);
  }
}

TEST(Lpips, IsSymmetricAndGrowsWithTheError) {
  const LpipsWeights weights = RandomLpipsWeights(4);
  const Image reference = RandomImage(50, 40, 0.0, 0.5, 1), noise = RandomImage(50, 40, 0, 0.5, 2);
  double last = 0.0;
  for (float amount : {0.01f, 0.1f, 1.0f}) {
    Image test = reference;
    for (std::size_t i = 0; i < test.rgb.size(); ++i) test.rgb[i] += amount * noise.rgb[i];
    const double distance = Lpips(reference, test, weights);
    EXPECT_GT(distance, last);
    EXPECT_EQ(distance, Lpips(test, reference, weights));
    last = distance;
  }
}

TEST(Lpips, FeaturesOf0Are0Apart) {
  LpipsWeights weights = RandomLpipsWeights(5);
  weights[0].biases.assign(weights[0].biases.size(), -1e6);
  for (std::size_t k = 1; k < weights.size(); ++k)
    weights[k].biases.assign(weights[k].biases.size(), 0);
  EXPECT_EQ(Lpips(RandomImage(31, 31, 0, 1, 1), RandomImage(31, 31, 0, 1, 2), weights), 0.0);
}

TEST(Lpips, SameBitsWhateverTheNumberOfThreads) {
  const LpipsWeights weights = RandomLpipsWeights(6);
  const Image a = RandomImage(120, 90, 0.0, 1.0, 1), b = RandomImage(120, 90, 0.0, 1.0, 2);
  const double distance = Lpips(a, b, weights);
  for (std::size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(Lpips(a, b, weights), distance) << threads;
  }
}

TEST(Lpips, SaysWhatItCantTake) {
  LpipsWeights weights = RandomLpipsWeights(7);
  const auto error = [&](const Image& x, const Image& y) {
    return ErrorOf([&] { Lpips(x, y, weights); });
  };
  EXPECT_EQ(error(Image(31, 31), Image(31, 31)), "");
  EXPECT_EQ(error(Image(30, 31), Image(30, 31)),
            "the reference: 30 x 31 pixels; LPIPS needs at least 31 x 31");
  EXPECT_THAT(error(Image(31, 31), Image(31, 30)), HasSubstr("the test image: 31 x 30 pixels; "));
  EXPECT_NE(error(Image(), Image()), "");

  const Image a = RandomImage(31, 31, 0, 1, 1), b = RandomImage(31, 31, 0, 1, 2);
  for (double large : {1e200, 1e308}) {  // squares, then features beyond double
    weights[2] = RandomLpipsWeights(7)[2];
    for (double& weight : weights[2].kernels) weight *= large;
    EXPECT_THAT(error(a, b), HasSubstr("too large")) << large;
  }
}

}  // namespace
}  // namespace pbnbrdf
