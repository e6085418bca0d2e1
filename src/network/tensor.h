// tensor.h: an array of numbers as weight files hold it.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

struct Tensor {
  std::vector<std::int64_t> shape;
  std::vector<double> values;  // row-major
};

// Larger files hold no network of the sizes that NetworkShape allows.
inline constexpr std::uintmax_t kMaxWeightFileSize = 64 << 20;  // bytes

// "6 x 21"; "a scalar" if there are no dimensions.
std::string ShapeText(const std::vector<std::int64_t>& shape);

// The little-endian numbers of type T that the bytes are.
template <typename T>
std::vector<double> ToDoubles(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return {values.begin(), values.end()};
}

// The product of the extents, or 0 if it is beyond `limit` or an extent isn't positive.
std::uint64_t ElementCount(const std::vector<std::int64_t>& shape, std::uint64_t limit);

}  // namespace pbnbrdf
