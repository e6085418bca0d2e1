// image.h: images in memory, and from files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pbnbrdf {

// The largest image that is read from a file: an environment map of 16384 x 8192 pixels.
inline constexpr std::size_t kMaxPixels = std::size_t(1) << 27;

// Linear RGB, height x width x 3, rows from the top.
struct Image {
  Image() = default;
  Image(int w, int h) : width(w), height(h), rgb(3 * std::size_t(w) * std::size_t(h)) {}

  float* pixel(int x, int y) {
    return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
  }
  const float* pixel(int x, int y) const {
    return &rgb[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x))];
  }

  int width = 0, height = 0;
  std::vector<float> rgb;
};

// Of an image: columns from left to before right, rows from top to before bottom.
struct PixelRegion {
  int left = 0, top = 0, right = 0, bottom = 0;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
  bool operator==(const PixelRegion&) const = default;
};

// An image of which a file stores a part (OpenEXR's data window); the rest is black.
struct StoredImage {
  Image image;
  PixelRegion stored;
  int left = 0, top = 0;  // where the file's coordinates have the image's first pixel
};

// The pixels of a region that lies in the image.
Image Crop(const Image& image, const PixelRegion& region);

// From an OpenEXR or PNG file, as its first bytes say. Throws Error as ReadExr and ReadPng do, and if it is
// neither.
Image OpenImage(const std::string& path);
StoredImage OpenStoredImage(const std::string& path);

}  // namespace pbnbrdf
