// uniform.h: random numbers that are the same on all machines; std::uniform_real_distribution differs between
// libraries.
#pragma once

#include <random>

namespace pbnbrdf {

// On the grid (k + 1/2) 2^-32 in (0, 1).
inline double Uniform(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 32) + 0.5) * 0x1p-32;
}

}  // namespace pbnbrdf
