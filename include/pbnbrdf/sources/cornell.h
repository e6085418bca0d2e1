// cornell.h: spectral measurements of the Cornell Program of Computer Graphics' goniometer [1], ".brdf".
//
// A text of numbers between blanks; # to the end of the line is a comment. The number of wavelengths, the
// wavelengths in nm, ascending, and then for each measurement
//
//   theta_i phi_i theta_s phi_s (radians; s: scattered)   f at each wavelength, in 1/sr, without the cosine
//
// The mirror direction is phi_s = phi_i + pi. Spectra become linear sRGB (src/sources/cie.h). Zeros are the
// noise floor: dark, not missing.
//
// [1] S. H. Westin et al. Reflectance Data, Cornell University Program of Computer Graphics.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Throws Error, naming the file and the line.
ScatteredBrdf ReadCornell(const std::string& path);

// Whether a text begins so: with a number of wavelengths and these.
bool LooksLikeCornell(std::string_view start);

}  // namespace pbnbrdf
