// median.h: the median of numbers.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

namespace pbnbrdf {

// The mean of the two in the middle if their number is even; NaN of none.
inline double Median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace pbnbrdf
