#include <string_view>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"

namespace pbnbrdf {

Image OpenImage(const std::string& path) {
  constexpr std::string_view kExr = "\x76\x2f\x31\x01", kPng = "\x89PNG";
  const std::string start = ReadStart(path, 4);
  if (start == kExr) return ReadExr(path);
  if (start == kPng) return ReadPng(path);
  Fail(path, ": neither an OpenEXR nor a PNG file");
}

}  // namespace pbnbrdf
