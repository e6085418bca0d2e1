#include "pbnbrdf/render/mesh.h"

#include <algorithm>

#include "mesh_files.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

// Twice its area over its longest edge squared, below which it is no more than a line.
constexpr double kLeastShape = 1e-12;

bool HasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({Dot(ab, ab), Dot(ac, ac), Dot(bc, bc)});
  return Length(Cross(ab, ac)) > kLeastShape * longest;
}

}  // namespace

TriangleMesh ReadMesh(const std::string& path) {
  const std::string bytes = ReadFile(path, kLargestFile);
  try {
    TriangleMesh mesh = bytes.starts_with("ply") ? ParsePly(bytes) : ParseObj(bytes);
    if (mesh.triangles.empty()) Fail("no faces: neither PLY nor Wavefront OBJ");
    CheckTriangles(mesh);
    return mesh;
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

TriangleMesh Transformed(const TriangleMesh& mesh, const Affine& map) {
  TriangleMesh placed = mesh;
  for (Vec3& p : placed.positions) p = map.Point(p);
  for (Vec3& n : placed.normals) n = map.Normal(n);
  if (map.Determinant() < 0.0) {
    for (auto& triangle : placed.triangles) std::swap(triangle[1], triangle[2]);
  }
  return placed;
}

void CheckTriangles(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!(LargestCoordinate(mesh.positions[i]) <= kLargestCoordinate)) {
      Fail("vertex ", i + 1, ": a coordinate isn't finite or is beyond ", kLargestCoordinate);
    }
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const double length = Length(mesh.normals[i]);
    if (!std::isfinite(length) || length == 0.0) {
      Fail("vertex ", i + 1, ": its normal isn't finite or has no length");
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (!HasArea(mesh.positions[a], mesh.positions[b], mesh.positions[c])) {
      Fail("triangle ", i + 1, ": has no area");
    }
  }
}

}  // namespace pbnbrdf
