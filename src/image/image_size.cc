#include "image/image_size.h"

#include <algorithm>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/image/image.h"

namespace pbnbrdf {
namespace {

// An image of one colour takes about a byte for so many pixels, compressed as well as OpenEXR can; a black frame
// around a small picture takes nothing. Images of up to 2 million pixels are read whatever their file's size.
constexpr std::uintmax_t kPixelsPerByte = 3000, kAlwaysPixels = std::uintmax_t{1} << 21;

}  // namespace

void CheckImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uintmax_t file_bytes) {
  if (width < 1 || height < 1) Fail(path, ": an image of ", width, " x ", height, " pixels");
  const std::uintmax_t pixels = std::uintmax_t(width) * std::uintmax_t(height);
  if (pixels > kMaxPixels) {
    Fail(path, ": ", width, " x ", height, " pixels, at most ", kMaxPixels, " are read");
  }
  if (pixels > std::max(kAlwaysPixels, kPixelsPerByte * file_bytes)) {
    Fail(path, ": says that it has ", width, " x ", height, " pixels; its ", file_bytes,
         " bytes can't hold them");
  }
}

}  // namespace pbnbrdf
