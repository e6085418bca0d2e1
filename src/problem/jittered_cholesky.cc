#include "problem/jittered_cholesky.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pbnbrdf {
namespace {

// The square roots of the diagonal, none of them 0.
std::vector<double> Scale(const double* a, int size) {
  std::vector<double> scale(size);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < size; ++i) {
    scale[i] = std::sqrt(std::max(0.0, a[i * std::size_t(size) + i]));
    if (scale[i] > 0.0) least = std::min(least, scale[i]);
  }
  if (!std::isfinite(least)) least = 1.0;
  std::replace(scale.begin(), scale.end(), 0.0, least);
  return scale;
}

}  // namespace

JitteredCholesky FactorWithJitter(const double* a, int size, double first_jitter) {
  const std::vector<double> scale = Scale(a, size);
  JitteredCholesky result = {Cholesky(size), first_jitter};
  for (;; result.jitter *= 10.0) {
    for (int i = 0; i < size; ++i) {
      double* row = result.lower.row(i);
      for (int j = 0; j < i; ++j) row[j] = a[i * std::size_t(size) + j] / (scale[i] * scale[j]);
      row[i] = a[i * std::size_t(size) + i] / (scale[i] * scale[i]) + result.jitter;
    }
    if (result.lower.Factor()) break;
  }
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j <= i; ++j) result.lower.row(i)[j] *= scale[i];
  }
  return result;
}

}  // namespace pbnbrdf
