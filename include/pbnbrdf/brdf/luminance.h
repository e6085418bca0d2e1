// luminance.h: how bright a colour is.
#pragma once

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// Y of linear sRGB (IEC 61966-2-1:1999), 1 for white.
inline double Luminance(const Rgb& linear) {
  return 0.21263900587151036 * linear[0] + 0.715168678767756 * linear[1] +
         0.07219231536073371 * linear[2];
}

}  // namespace pbnbrdf
