// analytic_starts.h: where the fit of an analytic model begins.
#pragma once

#include <span>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {

// The scalars of `count` starts: lobes from narrow to wide, a second lobe wider than the first. The
// diffuse albedo is that of the material's darker samples; lobes reflect what they must to have
// the brightness of the brightest ones.
std::vector<std::vector<double>> AnalyticStarts(const AnalyticModel& model, int lobes,
                                                std::span<const BrdfSample> samples, int count);

// The scalars of one lobe followed by those of a second one, wider and so faint that it changes
// next to nothing.
std::vector<double> WithFaintLobe(const AnalyticModel& model, std::vector<double> scalars);

}  // namespace pbnbrdf
