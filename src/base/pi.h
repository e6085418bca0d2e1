// pi.h: the number that nearly every file on directions needs.
#pragma once

#include <numbers>

namespace pbnbrdf {

inline constexpr double kPi = std::numbers::pi;

}  // namespace pbnbrdf
