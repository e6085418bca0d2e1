// show_rgb.h: colours in descriptions.
#pragma once

#include <string>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline std::string Show(const Rgb& rgb) {
  return StrCat("(", rgb[0], ", ", rgb[1], ", ", rgb[2], ")");
}

}  // namespace pbnbrdf
