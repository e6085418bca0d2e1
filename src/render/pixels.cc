#include "pixels.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {
namespace {

constexpr std::int64_t kLeastSamples = 32;
constexpr double kDark = 0.01;  // pixels of less radiance needn't be as exact

}  // namespace

void PixelSum::Add(const Rgb& sample) {
  for (int c = 0; c < 3; ++c) radiance[c] += sample[c];
  const double y = Luminance(sample);
  luminance += y;
  luminance_squares += y * y;
  ++samples;
}

double PixelSum::StandardError() const {
  const auto n = static_cast<double>(samples);
  const double squares = luminance_squares - luminance * luminance / n;
  return std::sqrt(squares < 0.0 ? 0.0 : squares / (n - 1.0) / n);
}

bool IsConverged(const PixelSum& pixel, double target_error) {
  if (pixel.samples < kLeastSamples) return false;
  const double mean = pixel.luminance / static_cast<double>(pixel.samples);
  return pixel.StandardError() < target_error * (mean + kDark);  // not if one overflowed
}

std::int64_t RemoveConverged(std::span<const PixelSum> pixels, int image_width, double target_error,
                             std::vector<PixelBlock>* blocks) {
  std::int64_t removed = 0;
  std::erase_if(*blocks, [&](const PixelBlock& block) {
    for (int y = block.y; y < block.y + block.height; ++y) {
      const auto row =
          pixels.subspan(std::size_t(y) * std::size_t(image_width) + std::size_t(block.x),
                         std::size_t(block.width));
      for (const PixelSum& pixel : row) {
        if (!IsConverged(pixel, target_error)) return false;
      }
    }
    removed += std::int64_t(block.width) * block.height;
    return true;
  });
  return removed;
}

}  // namespace pbnbrdf
