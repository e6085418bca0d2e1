// in_plane.h: scans in one plane, as text:
//
//   # phi_in theta_in phi_out theta_out brdf
//   15.0 180.0 -80.0 0.0 0.0131
//
// In degrees, and phi is the angle from the normal here, theta the azimuth. A negative phi is on the other side of
// the normal. f is in 1/sr, without the cosine. The line of names may be a comment or none, and its names end with
// _in and _out or with _i and _o. Columns are parted as in a CSV; blanks are usual.
#pragma once

#include <string>
#include <string_view>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Throws Error, naming the file and the line.
ScatteredBrdf ReadInPlane(const std::string& path);

// Whether a text begins with comments and the line of names.
bool LooksLikeInPlane(std::string_view start);

}  // namespace pbnbrdf
