// primaries.h: spectra of what has a colour only.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

inline constexpr double kFirstPrimaryWavelength = 400.0, kPrimaryWavelengthStep = 20.0;  // nm

// 400 to 700 nm.
std::vector<float> PrimaryWavelengths();

// A reflectance at each of these wavelengths for each of r, g, b: three smooth bands that sum to 1, mixed so that each
// is seen as its colour (sources/cie.h). Some are a little below 0.
std::vector<Vec3> SpectraOfPrimaries();

}  // namespace pbnbrdf
