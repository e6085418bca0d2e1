// color.h: colours as people see them, and how far two of them are apart.
//
// Linear RGB has the primaries of sRGB and Rec. 709 [1] and the white point D65, (1, 1, 1) is white.
// XYZ and CIELAB [2] are those of the 2 degree observer; CIELAB's white is that of the RGB.
//
// [1] ITU-R BT.709-6, 2015, and IEC 61966-2-1, 1999.
// [2] CIE 15:2004, Colorimetry.
// [3] G. Sharma, W. Wu, E. Dalal. The CIEDE2000 Color-Difference Formula: Implementation Notes,
//     Supplementary Test Data, and Mathematical Observations. Color Research and Application 30(1),
//     2005.
#pragma once

#include <array>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {

// X, Y, Z; Y is Luminance.
std::array<double, 3> ToXyz(const Rgb& linear);

// The inverse of ToXyz.
Rgb FromXyz(const std::array<double, 3>& xyz);

struct Lab {
  double l = 0.0;           // lightness: black 0, white 100
  double a = 0.0, b = 0.0;  // green to red, blue to yellow; greys 0
};

// Finite for all finite values >= 0, those beyond white too.
Lab ToLab(const Rgb& linear);

// CIE Delta E 2000 with kL = kC = kH = 1 [3]: symmetric, 0 for equal colours; about 1 is what people
// just see side by side. l >= 0.
double DeltaE2000(const Lab& x, const Lab& y);

// The part of the plain distance in CIELAB that isn't lightness: sqrt(da^2 + db^2).
double HueChromaDifference(const Lab& x, const Lab& y);

}  // namespace pbnbrdf
