// tensor.h: what the readers of weight files give.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pbnbrdf {

struct Tensor {
  std::vector<std::int64_t> shape;
  std::vector<double> values;  // row-major
};

// Larger files hold no network of the sizes that NetworkShape allows.
inline constexpr std::uintmax_t kLargestWeightFile = 64 << 20;  // bytes

// "6 x 21"; "a scalar" if there are no dimensions.
std::string ShapeText(const std::vector<std::int64_t>& shape);

// The product of the extents, or 0 if it is beyond `limit` or an extent isn't positive.
std::uint64_t ElementCount(const std::vector<std::int64_t>& shape, std::uint64_t limit);

}  // namespace pbnbrdf
