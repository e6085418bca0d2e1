// safetensors.h: the safetensors file format: an 8-byte little-endian header length, a JSON header,
// {"name": {"dtype", "shape", "data_offsets"}, ..., "__metadata__": {"key": "text"}}, and the
// tensors' bytes without gaps. Reading one runs no code.
#pragma once

#include <map>
#include <string>

#include "network/tensor.h"

namespace pbnbrdf {

struct SafetensorsFile {
  std::map<std::string, Tensor> tensors;
  std::map<std::string, std::string> metadata;
};

// Reads F64 and F32 tensors. Throws Error if the file is larger than max_size bytes, its header isn't what
// the format prescribes, the header and the file's length disagree, or a value isn't finite.
SafetensorsFile ReadSafetensors(const std::string& path,
                                std::uintmax_t max_size = kMaxWeightFileSize);

// The bytes of a file of F64 tensors, or of F32 ones.
std::string SafetensorsBytes(const SafetensorsFile& file, bool single = false);

}  // namespace pbnbrdf
