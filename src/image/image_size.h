// image_size.h: how large an image a file may hold.
#pragma once

#include <cstdint>
#include <string>

namespace pbnbrdf {

// Throws Error, which names the file, if a side is less than 1, or there are more pixels than kMaxPixels or than so
// many bytes of a file can hold: before memory is taken for them.
void CheckImageSize(const std::string& path, std::int64_t width, std::int64_t height,
                    std::uintmax_t file_bytes);

}  // namespace pbnbrdf
