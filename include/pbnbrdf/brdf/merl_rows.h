// merl_rows.h: where the rows of a MERL table lie in theta_h. Tables interpolate linearly between them,
// so that quadratures and encodings have to know them, too.
#pragma once

#include <numbers>

namespace pbnbrdf {

inline constexpr int kMerlRows = 90;

// theta_h of a row, 0 to kMerlRows, radians: (pi/2) (row / 90)^2.
inline double MerlRowAngle(int row) {
  const double t = static_cast<double>(row) / kMerlRows;
  return 0.5 * std::numbers::pi * t * t;
}

}  // namespace pbnbrdf
