#include "pixels.h"

#include <algorithm>
#include <cmath>

#include "pbnbrdf/brdf/luminance.h"
#include "rgb.h"

namespace pbnbrdf {
namespace {

// From 32 samples the standard error is known to about 1 / sqrt(2 * 31) = 13 %.
constexpr std::int64_t kMinSamples = 32;

// 1 % of white: the error of darker pixels is measured against this, as their noise is hardly seen.
constexpr double kDarkLuminance = 0.01;

}  // namespace

std::vector<PixelBlock> Cut(const PixelBlock& block, int side) {
  std::vector<PixelBlock> blocks;
  for (int y = 0; y < block.height; y += side) {
    for (int x = 0; x < block.width; x += side) {
      blocks.push_back({block.x + x, block.y + y, std::min(side, block.width - x),
                        std::min(side, block.height - y)});
    }
  }
  return blocks;
}

void PixelSum::Add(const Rgb& sample) {
  radiance = radiance + sample;
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
  if (pixel.samples < kMinSamples) return false;
  const double mean = pixel.luminance / static_cast<double>(pixel.samples);
  // False, too, if one of the sums has overflowed.
  return pixel.StandardError() < target_error * (mean + kDarkLuminance);
}

std::int64_t RemoveConverged(std::span<const PixelSum> pixels, int image_width, double target_error,
                             std::vector<PixelBlock>* blocks) {
  const auto converged = [&](const PixelSum& pixel) { return IsConverged(pixel, target_error); };
  std::int64_t removed = 0;
  std::erase_if(*blocks, [&](const PixelBlock& block) {
    for (int y = block.y; y < block.y + block.height; ++y) {
      const auto begin = pixels.begin() + std::ptrdiff_t(y) * image_width + block.x;
      if (!std::all_of(begin, begin + block.width, converged)) return false;
    }
    removed += std::int64_t(block.width) * block.height;
    return true;
  });
  return removed;
}

}  // namespace pbnbrdf
