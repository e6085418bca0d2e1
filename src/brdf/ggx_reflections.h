// ggx_reflections.h: reflections on GGX facets that are visible from wi, as importance_sampler.h
// explains them.
#pragma once

#include <array>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/brdf/lobe_widths.h"

namespace pbnbrdf {

// q(wo) + q(wo'), 1/sr, both directions above the horizon.
double GgxReflectionDensity(const DirectionPair& pair, LobeWidths alpha);

// wi above the horizon, u in [0, 1); wo.z >= 0.
Vec3 DrawGgxReflection(const Vec3& wi, LobeWidths alpha, const std::array<double, 2>& u);

}  // namespace pbnbrdf
