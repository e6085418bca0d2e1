// keras_archive.h: a whole model of Keras 3, NAME.keras: a ZIP archive with the weights as an HDF5 file.
#pragma once

#include <string>
#include <string_view>

namespace pbnbrdf {

// How each ZIP archive begins.
inline constexpr std::string_view kZipMagic = "PK\x03\x04";

// The weights in the archive `bytes`, for keras_h5.h. Throws Error, which names path, if the archive is damaged,
// has no weights or has more than kMaxWeightFileSize bytes of them.
std::string WeightsInArchive(const std::string& path, std::string_view bytes);

}  // namespace pbnbrdf
