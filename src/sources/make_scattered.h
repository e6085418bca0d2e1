// make_scattered.h: what readers of scattered measurements share once they have them.
#pragma once

#include <span>
#include <string>

#include "pbnbrdf/brdf/scattered.h"

namespace pbnbrdf {

// Whether all wi, but those at the normal, have the same azimuth, or the opposite one, which a sample turned by
// 180 degrees gives: what else phi_h does is then unknown, and the material taken for isotropic.
bool HaveOneIncidentAzimuth(std::span<const BrdfSample> samples);

// Its Error names the file.
ScatteredBrdf MakeScattered(const std::string& path, ScatteredData data);

}  // namespace pbnbrdf
