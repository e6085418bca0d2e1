// angles.h: pairs of directions from the angles of a file, which are checked.
#pragma once

#include <array>
#include <numbers>
#include <string>
#include <string_view>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline constexpr double kDegree = std::numbers::pi / 180.0;

// theta_i, phi_i, theta_o, phi_o in radians. A negative theta is on the other side of the normal: phi + pi.
// Throws Error, with `place` before and `hint` behind its message, if |theta| > pi or |phi| > 2 pi.
DirectionPair PairFromAngles(const std::string& place, const std::array<double, 4>& angles,
                             std::string_view hint = "");

}  // namespace pbnbrdf
