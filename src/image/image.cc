#include <algorithm>
#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"

namespace pbnbrdf {

Image Crop(const Image& image, const PixelRegion& region) {
  Image cropped(region.width(), region.height());
  for (int y = 0; y < cropped.height; ++y) {
    std::copy_n(image.pixel(region.left, region.top + y), 3 * cropped.width, cropped.pixel(0, y));
  }
  return cropped;
}

Image OpenImage(const std::string& path) { return OpenStoredImage(path).image; }

StoredImage OpenStoredImage(const std::string& path) {
  constexpr std::string_view kExr = "\x76\x2f\x31\x01", kPng = "\x89PNG";
  const std::string start = ReadStart(path, 4);
  if (start == kExr) return ReadStoredExr(path);
  if (start == kPng) {
    StoredImage png;
    png.image = ReadPng(path);
    png.stored = {0, 0, png.image.width, png.image.height};
    return png;
  }
  Fail(path, ": neither an OpenEXR nor a PNG file");
}

}  // namespace pbnbrdf
