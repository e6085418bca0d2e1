// half.h: numbers of half precision: IEEE 754's binary16, 11 bits of mantissa, up to 65504.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pbnbrdf {

inline constexpr double kMostHalf = 65504.0;

// The nearest number of half precision, ties to even; beyond kMostHalf infinite. It is normal or 0: graphics
// processors may take others for 0.
inline double NearestHalf(double x) {
  constexpr int kDigits = 11, kLeastExponent = -14;
  if (x == 0.0) return x;
  const int exponent = std::max(std::ilogb(x), kLeastExponent);
  const double step = std::ldexp(1.0, exponent - kDigits + 1);
  double nearest = step * std::nearbyint(x / step);
  const double least = std::ldexp(1.0, kLeastExponent);
  if (std::abs(nearest) < least)
    nearest = std::abs(x) > 0.5 * least ? std::copysign(least, x) : 0.0;
  return std::abs(nearest) > kMostHalf ? std::copysign(INFINITY, x) : nearest;
}

// The bits of one of these numbers, finite.
inline std::uint16_t HalfBits(double half) {
  constexpr int kBias = 15, kMantissaBits = 10;
  if (half == 0.0) return 0;
  const int exponent = std::ilogb(half);
  const double mantissa = std::ldexp(std::abs(half), kMantissaBits - exponent);  // from 1024 on
  const int bits = ((exponent + kBias - 1) << kMantissaBits) + static_cast<int>(mantissa);
  return static_cast<std::uint16_t>(bits | (half < 0.0 ? 0x8000 : 0));
}

}  // namespace pbnbrdf
