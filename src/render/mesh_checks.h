// mesh_checks.h: what Embree's single precision can hold, how exact it is, and parts of ReadMesh.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

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

// Their errors don't name the file. The meshes have indices in range; CheckTriangles checks the rest.
TriangleMesh ParseObj(std::string_view text);
TriangleMesh ParsePly(std::string_view bytes);

// Throws Error "triangle N: ..." or "vertex N: ..." if a triangle has no area, a normal has no length,
// or a coordinate is not finite or too large.
void CheckTriangles(const TriangleMesh& mesh);

}  // namespace pbnbrdf
