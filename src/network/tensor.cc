#include "network/tensor.h"

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  if (shape.empty()) return "a scalar";
  std::string text;
  for (std::int64_t extent : shape) text += StrCat(text.empty() ? "" : " x ", extent);
  return text;
}

std::uint64_t ElementCount(const std::vector<std::int64_t>& shape, std::uint64_t limit) {
  std::uint64_t count = 1;
  for (std::int64_t extent : shape) {
    if (extent < 1 || static_cast<std::uint64_t>(extent) > limit / count) return 0;
    count *= static_cast<std::uint64_t>(extent);
  }
  return count;
}

}  // namespace pbnbrdf
