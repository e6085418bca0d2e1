// value_at.h: a Brdf at a single pair of directions.
#pragma once

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

inline Rgb ValueAt(const Brdf& brdf, const DirectionPair& pair) {
  Rgb value;
  brdf.Evaluate({&pair, 1}, {&value, 1});
  return value;
}

}  // namespace pbnbrdf
