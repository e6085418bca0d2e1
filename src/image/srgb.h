// srgb.h: the transfer function of sRGB (IEC 61966-2-1:1999), between light and what a file of 8 or
// 16 bits or a screen is given.
#pragma once

#include <cmath>

namespace pbnbrdf {

// linear, which is cut to [0, 1] (NaN: 0), to the encoded value in [0, 1].
inline double ToSrgb(double linear) {
  if (!(linear > 0.0)) return 0.0;
  if (linear >= 1.0) return 1.0;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// The inverse; encoded in [0, 1].
inline double FromSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace pbnbrdf
