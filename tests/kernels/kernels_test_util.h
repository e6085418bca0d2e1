// kernels_test_util.h: what tests of kernels share: both precisions with their tolerance, numbers.
#pragma once

#include <limits>
#include <vector>

#include "test_util.h"

namespace pbnbrdf::kernels {

template <typename T>
std::vector<T> Random(std::size_t count, unsigned seed) {
  const std::vector<double> numbers = RandomNumbers(count, -1.0, 1.0, seed);
  return {numbers.begin(), numbers.end()};
}

template <typename T>
class Kernels : public testing::Test {
 protected:
  // A sum of n products of numbers up to 1 is off by at most about n^2 eps; this is for n <= 128.
  static constexpr double kTolerance = 256.0 * std::numeric_limits<T>::epsilon();
};

using Precisions = testing::Types<float, double>;

}  // namespace pbnbrdf::kernels
