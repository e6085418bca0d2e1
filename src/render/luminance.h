// luminance.h: how bright a colour is.
#pragma once

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// Y of linear sRGB, ITU-R BT.709.
inline double Luminance(const Rgb& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

}  // namespace pbnbrdf
