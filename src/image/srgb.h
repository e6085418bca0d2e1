// srgb.h: the transfer function of sRGB (IEC 61966-2-1:1999), between light and what a file of 8 or
// 16 bits or a screen is given.
#pragma once

namespace pbnbrdf {

// linear, which is cut to [0, 1] (NaN: 0), to the encoded value in [0, 1].
double ToSrgb(double linear);

// The inverse; encoded in [0, 1].
double FromSrgb(double encoded);

}  // namespace pbnbrdf
