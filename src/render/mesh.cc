#include "pbnbrdf/render/mesh.h"

#include "base/about.h"
#include "mesh_checks.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "polygons.h"

namespace pbnbrdf {
namespace {

// 4 GiB: more triangles than fit in memory with Embree's tree about them.
constexpr std::uintmax_t kMaxMeshBytes = std::uintmax_t{4} << 30;

// The least ratio of a triangle's double area to its longest edge squared. Where it is less, rounding
// of the corners decides the normal.
constexpr double kMinShape = 1e-12;

bool HasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest = std::max({Dot(ab, ab), Dot(ac, ac), Dot(bc, bc)});
  return Length(Cross(ab, ac)) > kMinShape * longest;
}

}  // namespace

TriangleMesh ReadMesh(const std::string& path) {
  const std::string bytes = ReadFile(path, kMaxMeshBytes);
  return About(path, [&] {
    const PolygonMesh polygons = bytes.starts_with("ply") ? ParsePly(bytes) : ParseObj(bytes);
    if (polygons.face_ends.empty()) Fail("no faces: neither PLY nor Wavefront OBJ");
    TriangleMesh mesh = Triangulated(polygons);
    LeaveOutSlivers(&mesh);
    return mesh;
  });
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

TriangleMesh ParallelogramMesh(const Vec3& center, const Vec3& x, const Vec3& y) {
  TriangleMesh mesh;
  mesh.positions = {center - x - y, center + x - y, center + x + y, center - x + y};
  mesh.triangles = {{{0, 1, 2}, {0, 2, 3}}};
  return mesh;
}

void LeaveOutSlivers(TriangleMesh* mesh) {
  for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
    if (!(LargestCoordinate(mesh->positions[i]) <= kMaxCoordinate)) {
      Fail("vertex ", i + 1, ": a coordinate isn't finite or is beyond ", kMaxCoordinate);
    }
  }
  for (std::size_t i = 0; i < mesh->normals.size(); ++i) {
    const double length = Length(mesh->normals[i]);
    if (!std::isfinite(length) || length == 0.0) {
      Fail("vertex ", i + 1, ": its normal isn't finite or has no length");
    }
  }
  const auto is_sliver = [&](const auto& triangle) {
    const auto& [a, b, c] = triangle;
    return !HasArea(mesh->positions[a], mesh->positions[b], mesh->positions[c]);
  };
  mesh->left_out += std::erase_if(mesh->triangles, is_sliver);
  if (mesh->triangles.empty()) Fail("no triangle has an area");
}

}  // namespace pbnbrdf
