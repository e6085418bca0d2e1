// curves.h: what a page plots of a material and a fit: slices of f, and directional albedos.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// Where a material isn't known, its value is NaN.
struct PlotCurve {
  double angle;                    // degrees, of what stays the same along the curve
  std::vector<double> x;           // degrees, ascending
  std::vector<Rgb> material, fit;  // f, 1/sr
  std::vector<double> measured_x;  // where f was measured within a degree or so of the curve
  std::vector<Rgb> measured;
};

// In the plane of incidence: angle is theta_i, x is theta_o, positive on the other side of the normal, where the
// mirror direction is. Incident angles at which the material was measured are preferred.
std::vector<PlotCurve> InPlaneCurves(const Brdf& material, const Brdf& fit);

// Through lobes: angle is theta_d, x is theta_h, at phi_d = 90 degrees; as far as both directions are above the
// horizon.
std::vector<PlotCurve> HalfAngleCurves(const Brdf& material, const Brdf& fit);

struct AlbedoCurves {
  std::vector<double> theta_i;     // degrees
  std::vector<Rgb> material, fit;  // of the material NaN beyond 85 degrees
};

AlbedoCurves MeasureAlbedoCurves(const Brdf& material, const Brdf& fit);

}  // namespace pbnbrdf
