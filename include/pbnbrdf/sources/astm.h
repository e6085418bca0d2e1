// astm.h: measurements as in ASTM E1392-96, as the Cornell Program of Computer Graphics publishes them: the layout
// that two other readers, ALTA and libbsdf, agree on.
//
// Lines of a keyword and its value, of which NUM_POINTS n and VARS are read; VARS is the last and names the columns:
//
//   VARS theta_i,phi_i,theta_s,phi_s,R,G,B
//
// Angles are in radians (s: scattered); phi_i may be missing: 0. The others are one value, or R,G,B, or X,Y,Z, or
// one for each wavelength, 400nm,410nm,...: f in 1/sr, without the cosine. Then come n rows of numbers between
// commas. Spectra and X,Y,Z become linear sRGB (src/sources/cie.h).
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Throws Error, naming the file and the line.
ScatteredBrdf ReadAstm(const std::string& path);

// Whether a line VARS of a text names theta_i and theta_s.
bool LooksLikeAstm(std::string_view start);

}  // namespace pbnbrdf
