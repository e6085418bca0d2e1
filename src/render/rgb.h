// rgb.h: arithmetic of colours, channel by channel.
#pragma once

#include <cmath>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline Rgb operator*(const Rgb& a, const Rgb& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline Rgb operator*(double s, const Rgb& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Rgb operator-(const Rgb& a, const Rgb& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

inline bool IsFinite(const Rgb& a) {
  return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]);
}

}  // namespace pbnbrdf
