// half_diff.h: direction pairs <-> half and difference vectors [1]. Angles in radians.
//
//   h = normalize(wi + wo) at (theta_h, phi_h),  d = Ry(-theta_h) Rz(-phi_h) wi at (theta_d, phi_d)
//
// Exchanging wi and wo sends (d.x, d.y, d.z) to (-d.x, -d.y, d.z), that is phi_d to phi_d + pi, and
// here to the last bit: d.z = |wi + wo| / 2 and the tangential part of d is that of (wi - wo) / 2.
//
// [1] S. Rusinkiewicz. A New Change of Variables for Efficient BRDF Representation. EGWR 1998.
#pragma once

#include <array>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/brdf/operations.h"

namespace pbnbrdf {

#include "pbnbrdf/brdf/half_diff-inl.h"

// Of the components of wi and wo.
template <class V>
HalfDiffOf<V> HalfDiffFromPair(const std::array<V, 3>& wi, const std::array<V, 3>& wo) {
  return HalfDiffFromSum<V>({wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]},
                            {wi[0] - wo[0], wi[1] - wo[1], wi[2] - wo[2]});
}

struct HalfDiff {
  Vec3 h;  // unit, shading frame
  Vec3 d;  // unit, frame of h
};

struct RusinkiewiczAngles {
  double theta_h = 0.0;  // [0, pi/2]
  double theta_d = 0.0;  // [0, pi/2]
  double phi_d = 0.0;    // [0, 2 pi)
  double phi_h = 0.0;    // [0, 2 pi); isotropic materials don't depend on it
};

// At h = +z, where phi_h is undefined, phi_h = 0; at wi = -wo, where h is, h = +z.
HalfDiff ToHalfDiff(const DirectionPair& pair);

RusinkiewiczAngles ToAngles(const DirectionPair& pair);

// Either direction of the result may lie below the horizon.
DirectionPair FromAngles(const RusinkiewiczAngles& angles);

}  // namespace pbnbrdf
