// half_vector_cells.h: the cells of a Proposal (importance_sampler.h) over half vectors.
#pragma once

#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/importance_sampler.h"

namespace pbnbrdf {

// Places in the cells: u in [0, 1] over the rings, v in [0, 1] over the sectors.
class HalfVectorCells {
 public:
  explicit HalfVectorCells(const Proposal& proposal)
      : spread_(proposal.spread),
        log_(std::log1p(1.0 / proposal.spread)),
        folded_(proposal.IsIsotropic()),
        turn_((folded_ ? 1.0 : 2.0) * std::numbers::pi) {}

  double U(double one_minus_cosine) const { return std::log1p(one_minus_cosine / spread_) / log_; }

  // v of a half vector (x, y, .) in the frame of Axis.
  double V(double x, double y) const {
    const double phi = std::atan2(y, x);
    if (folded_) return std::abs(phi) / turn_;
    return (phi < 0.0 ? phi + turn_ : phi) / turn_;
  }

  // The half vector at (u, v), y >= 0 if the cells are isotropic.
  Vec3 At(double u, double v) const {
    const double depth = spread_ * std::expm1(u * log_);  // 1 - cos_h
    const double sine = std::sqrt(depth * (2.0 - depth)), phi = turn_ * v;
    return {sine * std::cos(phi), sine * std::sin(phi), 1.0 - depth};
  }

  // du dv per solid angle of h, over both sides of the plane of incidence.
  double Density(double one_minus_cosine) const {
    return 1.0 / (2.0 * std::numbers::pi * log_ * (spread_ + one_minus_cosine));
  }

  // The x axis of the frame: the plane of incidence, or that of the material.
  static Vec3 Axis(const Proposal& proposal, const Vec3& wi) {
    const double length = std::hypot(wi.x, wi.y);
    if (!proposal.IsIsotropic() || !(length > 0.0)) return {1.0, 0.0, 0.0};
    return {wi.x / length, wi.y / length, 0.0};
  }

 private:
  double spread_, log_;
  bool folded_;  // both sides of the plane of incidence are the same
  double turn_;  // that all sectors cover
};

// 1 - cos_h, with the digits of narrow lobes.
inline double OneMinusCosine(const Vec3& h) { return (h.x * h.x + h.y * h.y) / (1.0 + h.z); }

// The vector of the frame that has this x axis, in that of the material.
inline Vec3 FromFrame(const Vec3& axis, const Vec3& v) {
  return {axis.x * v.x - axis.y * v.y, axis.y * v.x + axis.x * v.y, v.z};
}

// The reflection of wi on h.
inline Vec3 Reflected(const Vec3& wi, const Vec3& h) { return 2.0 * Dot(wi, h) * h - wi; }

}  // namespace pbnbrdf
