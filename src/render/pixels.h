// pixels.h: the sums of a pixel's samples, and when a pixel has enough of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

struct PixelBlock {
  int x, y, width, height;
};

// Cuts the block into squares of the given side; those at its right and bottom may be smaller.
std::vector<PixelBlock> Cut(const PixelBlock& block, int side);

struct PixelSum {
  Rgb radiance = {};
  double luminance = 0.0, luminance_squares = 0.0;
  std::int64_t samples = 0;  // in the sums

  void Add(const Rgb& sample);
  double StandardError() const;  // of the mean luminance; needs two samples
};

// Whether the pixel has reached target_error > 0, as RenderOptions::target_error defines it.
bool IsConverged(const PixelSum& pixel, double target_error);

// Pixels stop in blocks of 4 x 4, when all 16 are converged: a single pixel would stop too early if
// its first samples happened to miss rare bright paths.
inline constexpr int kConvergenceBlock = 4;

// Removes the blocks in which every pixel is converged, and returns the number of their pixels.
// `pixels` are those of the image, row by row.
std::int64_t RemoveConverged(std::span<const PixelSum> pixels, int image_width, double target_error,
                             std::vector<PixelBlock>* blocks);

}  // namespace pbnbrdf
