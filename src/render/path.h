// path.h: the state of a path.
#pragma once

#include <cstddef>

#include "random.h"
#include "rgb.h"

namespace pbnbrdf {

struct Path {
  std::size_t pixel = 0;  // of the image, row by row
  Random random;
  Rgb throughput = {1.0, 1.0, 1.0};  // product of f cos / pdf over the reflections so far
  Rgb radiance = {};                 // found so far
};

}  // namespace pbnbrdf
