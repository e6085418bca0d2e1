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
  std::size_t left_out = 0;  // how many triangles of the file aren't there: they have no area
};

// Reads one of these; the file's first bytes say which:
//
// Wavefront OBJ: v, vn and f lines. Indices may be negative, or of a vertex further on; a line that ends in "\" goes
// on in the next one, and "#" begins a comment. All else is ignored: texture coordinates, groups, materials.
//
// PLY, ascii or binary of either byte order: x, y, z of "vertex", its nx, ny, nz if all three are there, and
// the list vertex_indices or vertex_index of "face". Other elements and properties are skipped.
//
// Faces of more than three corners are cut into triangles, concave ones too (at most 1,000 corners). Where some corners
// have normals, the others get the normal of their face. Triangles without area, as of corners in one place, are left
// out. (Assimp, Debian's reader of both formats, stops at a byte order mark and at a comment behind a face, keeps
// slivers, and reads single precision.)
//
// Throws Error, which names the file and, of OBJ, the line: if the file is missing, truncated or of another format,
// has no triangle with an area, an index out of range, or a coordinate that is not finite or beyond 1e15.
TriangleMesh ReadMesh(const std::string& path);

// The mesh as the map places it; its determinant must not be 0. If the map reflects, the triangles'
// corners change their order, so that the outside stays outside.
TriangleMesh Transformed(const TriangleMesh& mesh, const Affine& map);

// Two triangles. x, y: half of its sides; x times y is its normal.
TriangleMesh ParallelogramMesh(const Vec3& center, const Vec3& x, const Vec3& y);

}  // namespace pbnbrdf
