// zemax.h: tabular BSDF of Zemax OpticStudio [1], ".bsdf".
//
// A text; lines with # are comments, and keywords may have capitals or not:
//
//   Source Measured,  Symmetry PlaneSymmetrical | Asymmetrical | Asymmetrical4D,
//   SpectralContent Monochrome | XYZ,  ScatterType BRDF  (BTDF is refused),
//   SampleRotation n, AngleOfIncidence n, ScatterAzimuth n, ScatterRadial n: each followed by n angles, degrees,
//   Monochrome (or TristimulusX, and then the same with Y and Z), DataBegin,
//   for each rotation and each incidence: TIS and a number, which isn't used, and f for each azimuth and each
//   radial angle, the last varying fastest, in 1/sr, without the cosine, and DataEnd.
//
// Azimuth A and radial angle R are about the specular direction, and A = 0 is towards the normal. For incidence i
// and s = (sin R cos A, sin R sin A, cos R), at rotation 0,
//
//   wi = (-sin i, 0, cos i),   wo = (-s_x cos i + s_z sin i, s_y, s_x sin i + s_z cos i).
//
// A rotation turns both about the normal. PlaneSymmetrical gives A from 0 to 180 degrees and stands for the mirror
// image, too. Zero is what wasn't measured: missing. XYZ becomes linear sRGB.
//
// [1] R. Rykowski. BSDF Data Interchange File Format Specification. Zemax, 2008.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Throws Error, naming the file and the line.
ScatteredBrdf ReadZemax(const std::string& path);

// Whether lines of a text begin with some of the keywords.
bool LooksLikeZemax(std::string_view start);

}  // namespace pbnbrdf
