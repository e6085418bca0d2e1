// ggx.h: the GGX distribution of facet normals and its masking, templated on the scalar. Models, and the
// sampling of directions, are made of them.
//
// [1] B. Walter, S. Marschner, H. Li, K. Torrance. Microfacet Models for Refraction through Rough
//     Surfaces. EGSR 2007.
// [2] E. Heitz. Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs. JCGT 3(2),
//     2014.
#pragma once

#include <numbers>

#include "pbnbrdf/brdf/reflection_geometry.h"

namespace pbnbrdf {

// Smith's masking of one direction above the horizon for GGX, eq. 34 of [1], elliptic as in [2], with the width that
// the lobe has along the direction's azimuth: 2 / (1 + sqrt(1 + alpha^2 tan^2 theta)).
template <typename T>
T GgxMasking(const Vec3& w, const T& alpha_x, const T& alpha_y) {
  using std::sqrt;
  const T x = w.x * alpha_x, y = w.y * alpha_y;
  return 2.0 / (1.0 + sqrt(1.0 + (x * x + y * y) / (w.z * w.z)));
}

// D of GGX, 1/sr.
template <typename T>
T GgxDistribution(const ReflectionGeometry& g, const T& alpha_x, const T& alpha_y) {
  const T spread = 1.0 + StretchedTan2(g, alpha_x, alpha_y);
  const double cos2 = g.cos_h * g.cos_h;
  return std::numbers::inv_pi / (cos2 * cos2 * alpha_x * alpha_y * spread * spread);
}

}  // namespace pbnbrdf
