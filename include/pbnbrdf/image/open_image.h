// open_image.h: an image from a file of either kind.
#pragma once

#include <string>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// ReadExr or ReadPng, as the file's first bytes say. Throws Error as these do, and if it is neither.
Image OpenImage(const std::string& path);

}  // namespace pbnbrdf
