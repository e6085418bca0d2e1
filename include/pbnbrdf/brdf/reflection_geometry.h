// reflection_geometry.h: the quantities of a pair of directions that analytic models are made of.
#pragma once

#include <algorithm>
#include <cmath>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// Of a pair above the horizon. The half vector is that of the unnormalised sum wi + wo: 1 - cos^2
// would lose the digits of narrow lobes.
struct ReflectionGeometry {
  explicit ReflectionGeometry(const DirectionPair& pair)
      : wi(pair.wi),
        wo(pair.wo),
        sum(pair.wi + pair.wo),
        cos_h(sum.z / Length(sum)),
        cos_d(std::min(0.5 * Length(sum), 1.0)) {}

  // tan^2 theta_h
  double Tan2H() const { return (sum.x * sum.x + sum.y * sum.y) / (sum.z * sum.z); }
  // 1 - cos theta_h
  double VersineH() const { return Tan2H() * cos_h * cos_h / (1.0 + cos_h); }

  Vec3 wi, wo, sum;
  double cos_h;  // cos theta_h
  double cos_d;  // cos theta_d = wi.h = wo.h
};

inline double Pow5(double x) { return x * x * x * x * x; }

// Schlick's Fresnel reflectance [1] at wi.h = cos_d, in [0, 1], of f0 at normal incidence.
//
// [1] C. Schlick. An Inexpensive BRDF Model for Physically-based Rendering. Eurographics 1994.
template <typename T>
T SchlickFresnel(const T& f0, double cos_d) {
  return f0 + (1.0 - f0) * Pow5(1.0 - cos_d);
}

// tan^2 theta_h over the squared width of an elliptic lobe along phi_h: (h.x / x)^2 + (h.y / y)^2,
// for h.z = 1.
template <typename T>
T StretchedTan2(const ReflectionGeometry& g, const T& width_x, const T& width_y) {
  const T x = g.sum.x / width_x, y = g.sum.y / width_y;
  return (x * x + y * y) / (g.sum.z * g.sum.z);
}

}  // namespace pbnbrdf
