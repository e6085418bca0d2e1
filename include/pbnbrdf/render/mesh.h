// mesh.h: triangle meshes, and the files that hold them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pbnbrdf/render/affine.h"

namespace pbnbrdf {

struct TriangleMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  // one for each position, not of unit length; empty: flat triangles
  std::vector<std::array<std::uint32_t, 3>> triangles;  // positions, counterclockwise from outside
};

// Reads one of these; the file's first bytes say which:
//
// Wavefront OBJ: v, vn and f lines. Faces of more than three corners become fans of triangles;
// indices may be negative. All else is ignored: texture coordinates, groups, materials. Normals are
// kept if each corner of each face has one; a position with several normals is repeated.
//
// PLY, ascii or binary_little_endian: x, y, z of "vertex", its nx, ny, nz if all three are there, and
// the list vertex_indices or vertex_index of "face". Other elements and properties are skipped.
//
// Throws Error, which names the file and, in a text file, the line: if the file is missing, truncated
// or of another format, has no triangles, an index out of range, a triangle without area, or a
// coordinate that is not finite or beyond 1e15.
TriangleMesh ReadMesh(const std::string& path);

// The mesh as the map places it; its determinant must not be 0. If the map reflects, the triangles'
// corners change their order, so that the outside stays outside.
TriangleMesh Transformed(const TriangleMesh& mesh, const Affine& map);

// Two triangles. x, y: half of its sides; x times y is its normal.
TriangleMesh ParallelogramMesh(const Vec3& center, const Vec3& x, const Vec3& y);

}  // namespace pbnbrdf
