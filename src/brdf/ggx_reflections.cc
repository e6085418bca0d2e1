#include "brdf/ggx_reflections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/ggx.h"

namespace pbnbrdf {
namespace {

Vec3 Normalized(const Vec3& v) { return (1.0 / Length(v)) * v; }

// q / G1; 0 where the half vector is below the horizon.
double UnmaskedDensity(const DirectionPair& pair, LobeWidths alpha) {
  const ReflectionGeometry g(pair);
  if (!(g.sum.z > 0.0)) return 0.0;
  return GgxDistribution(g, alpha.x, alpha.y) * 0.25 / pair.wi.z;
}

}  // namespace

double GgxReflectionDensity(const DirectionPair& pair, LobeWidths alpha) {
  const Vec3 mirrored = {pair.wo.x, pair.wo.y, -pair.wo.z};
  return GgxMasking(pair.wi, alpha.x, alpha.y) *
         (UnmaskedDensity(pair, alpha) + UnmaskedDensity({pair.wi, mirrored}, alpha));
}

Vec3 DrawGgxReflection(const Vec3& wi, LobeWidths alpha, const std::array<double, 2>& u) {
  // In a frame where the facets are a hemisphere, those seen from w reflect it evenly into the cap
  // of directions higher than -w.z (Dupuy and Benyoub 2023).
  const Vec3 w = Normalized({alpha.x * wi.x, alpha.y * wi.y, wi.z});
  const double z = (1.0 - u[0]) * (1.0 + w.z) - w.z, phi = 2.0 * std::numbers::pi * u[1];
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - z * z));
  const Vec3 facet = Vec3{sin_theta * std::cos(phi), sin_theta * std::sin(phi), z} + w;
  const Vec3 h = Normalized({alpha.x * facet.x, alpha.y * facet.y, std::max(0.0, facet.z)});
  const Vec3 wo = 2.0 * Dot(wi, h) * h - wi;
  return {wo.x, wo.y, std::abs(wo.z)};
}

}  // namespace pbnbrdf
