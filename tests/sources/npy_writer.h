// npy_writer.h: .npy files for tests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "test_util.h"

namespace pbnbrdf {

// "\x93NUMPY", version 1 or 2, the header and what follows it.
inline std::string NpyBytes(const std::string& header, const std::string& data, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += {version, '\0'};
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  for (std::size_t n = 0; n < length_bytes; ++n) {
    bytes += static_cast<char>(header.size() >> (8 * n) & 0xff);
  }
  return bytes + header + data;
}

// "{'descr': '<f4', 'fortran_order': False, 'shape': (6, 21), }\n"
inline std::string NpyHeader(std::string_view type, std::string_view shape,
                             std::string_view fortran_order = "False") {
  return StrCat("{'descr': '", type, "', 'fortran_order': ", fortran_order, ", 'shape': (", shape,
                "), }\n");
}

// The values' bytes as elements of type T.
template <typename T>
std::string ElementBytes(const std::vector<double>& values) {
  const std::vector<T> elements(values.begin(), values.end());
  return std::string(reinterpret_cast<const char*>(elements.data()), elements.size() * sizeof(T));
}

}  // namespace pbnbrdf
