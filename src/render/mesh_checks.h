// mesh_checks.h: what Embree's single precision can hold, and how exact it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "pbnbrdf/render/mesh.h"

namespace pbnbrdf {

// The error of Embree's coordinates, relative to the largest of them, and of its directions in radians:
// a few roundings of 2^-24 = 6e-8 each.
inline constexpr double kSinglePrecision = 1e-6;

// Keeps products of two coordinates, such as areas, far from the largest float, 3e38.
inline constexpr double kMaxCoordinate = 1e15;

// The largest magnitude of the three; infinite if one is not finite.
inline double LargestCoordinate(const Vec3& a) {
  const bool finite = std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
  return finite ? std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)})
                : std::numeric_limits<double>::infinity();
}

// No coordinate is larger on the image of the unit sphere.
inline double LargestCoordinate(const Affine& map) {
  double sum = LargestCoordinate(map.origin);
  for (const Vec3& axis : map.axes) sum += LargestCoordinate(axis);
  return sum;
}

// Takes out triangles without area and adds their number to left_out. Throws Error if that leaves none, or, as
// "vertex N: ...", if a coordinate is not finite or too large or a normal not finite or without length.
void LeaveOutSlivers(TriangleMesh* mesh);

}  // namespace pbnbrdf
