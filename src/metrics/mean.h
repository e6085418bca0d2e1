// mean.h: the mean of errors.
#pragma once

#include <numeric>
#include <vector>

namespace pbnbrdf {

// 0 of none.
inline double Mean(const std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

}  // namespace pbnbrdf
