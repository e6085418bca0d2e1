// value_table.h: an isotropic material as a small table for a shader.
#pragma once

#include <cstdint>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

struct ValueTableSize {
  int theta_h, theta_d, phi_d;
};

// log(1 + f / kValueTableUnit) of a material's values averaged over both orders, as half floats, RGB; theta_h is
// innermost, phi_d outermost. Texel centres, in units of the whole range: theta_h = (pi/2) u^2, theta_d =
// (pi/2) v, phi_d = pi w, which repeats. Below the horizon stand the last values above it along theta_h, so that
// what is interpolated above it is right.
std::vector<std::uint16_t> ValueTable(const Brdf& material, const ValueTableSize& size);

inline constexpr double kValueTableUnit = 1e-3;  // 1/sr

}  // namespace pbnbrdf
