// png.h: images as PNG files, for looking at them.
#pragma once

#include <string>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// The file's bytes: RGB of 8 bits, sRGB(exposure * value) rounded, where the product is cut to [0, 1]
// (srgb.h; NaN is written as 0). The image must have pixels; exposure > 0.
std::string PngBytes(const Image& image, double exposure = 1.0);

// The same, written as WriteFile does.
void WritePng(const std::string& path, const Image& image, double exposure = 1.0);

// Linear RGB in [0, 1] from a PNG of any kind, 16 bits kept. Values are taken as sRGB, whatever a gamma
// chunk says; grey gives three equal channels, and transparent pixels lie on black. Throws Error, which
// names the file, if it is missing, isn't PNG, is truncated or damaged, or has more than kMaxPixels.
Image ReadPng(const std::string& path);

}  // namespace pbnbrdf
