// pixels.h: the samples of a pixel, and when there are enough of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pbnbrdf/brdf/direction.h"
#include "tiles.h"

namespace pbnbrdf {

struct PixelSum {
  Rgb radiance = {};
  double luminance = 0.0, luminance_squares = 0.0;
  std::int64_t samples = 0;  // in the sums

  void Add(const Rgb& sample);
  double StandardError() const;  // of the mean luminance; at least two samples
};

// The rule of RenderOptions::target_error, which must be > 0, for one pixel.
bool IsConverged(const PixelSum& pixel, double target_error);

// Pixels are judged in squares of this many a side, all of which must be converged: a pixel alone
// would stop too soon if its first samples missed what is rarely found.
inline constexpr int kJudgedTogether = 4;

// Removes the blocks whose pixels are all converged; `pixels` are those of the image, of the given
// width. Returns the number of pixels in those removed.
std::int64_t RemoveConverged(std::span<const PixelSum> pixels, int image_width, double target_error,
                             std::vector<PixelBlock>* blocks);

}  // namespace pbnbrdf
