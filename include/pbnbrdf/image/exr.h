// exr.h: images as OpenEXR files, https://openexr.com.
#pragma once

#include <map>
#include <string>

#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

// The channels R, G and B, or Y alone as grey, stored as half, float or unsigned integer, by scan lines or tiles
// (of these the full resolution), with any of OpenEXR's compressions; of several parts the first that has them.
// The image is the display window: what is stored beyond it is cut off, and it is black where nothing is stored.
// Colours of other primaries than sRGB's (attribute chromaticities) are converted to linear sRGB. Values come as
// they are: negative and non-finite ones, too.
//
// Throws Error, which names the file, if it is missing, isn't OpenEXR, is truncated or damaged, lacks
// one of the channels or stores it at a lower resolution, or has more than kMaxPixels pixels or sides
// or tiles beyond 65536; these are looked at before memory is taken for the image.
Image ReadExr(const std::string& path);

// The same, and which part of it the file stores.
StoredImage ReadStoredExr(const std::string& path);

// The same as ReadExr, of an environment map. Throws Error if the file says that it is a cube map.
Image ReadLatLongExr(const std::string& path);

// The file's bytes: R, G and B as float, scan lines, ZIP compression; each entry of the metadata is an
// attribute of type string. The image must have pixels. Throws Error if an attribute's name is empty,
// longer than 255 bytes or one of OpenEXR's own of another type, such as "compression".
std::string ExrBytes(const Image& image, const std::map<std::string, std::string>& metadata = {});

// The same, written as WriteFile does.
void WriteExr(const std::string& path, const Image& image,
              const std::map<std::string, std::string>& metadata = {});

}  // namespace pbnbrdf
