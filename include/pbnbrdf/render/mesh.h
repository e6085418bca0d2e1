// mesh.h: triangle meshes and the files that hold them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pbnbrdf/render/affine.h"

namespace pbnbrdf {

struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  // one for each position, any length but 0; or none: flat triangles
  std::vector<std::array<std::uint32_t, 3>>
      triangles;  // into positions, counterclockwise from outside
};

// Wavefront OBJ: v, vn and f lines, faces of three corners or more (as fans), negative indices
// too; all else (texture coordinates, groups, materials) is left out. Normals are kept if every
// corner of every face has one; a position with several of them is repeated.
//
// PLY, ascii or binary_little_endian: x, y, z and, where they all are, nx, ny, nz of "vertex", the
// list vertex_indices or vertex_index of "face"; other elements and properties are skipped.
//
// Both throw Error, which names the file and, of a text, the line, if it is missing, truncated or
// of another format, has no triangles, an index out of range, or a coordinate that isn't finite or
// is beyond kLargestCoordinate, or a face without area. The file's first bytes say which format it
// is.
TriangleMesh ReadMesh(const std::string& path);

// Embree computes in single precision.
inline constexpr double kLargestCoordinate = 1e15;

// The mesh as the map places it; turned inside out by a reflection, the triangles change
// orientation, so that their normals go where the map's do. Its determinant must not be 0.
TriangleMesh Transformed(const TriangleMesh& mesh, const Affine& map);

// Throws Error "triangle N: ..." if a triangle has no area or a coordinate isn't finite or is too
// large.
void CheckTriangles(const TriangleMesh& mesh);

}  // namespace pbnbrdf
