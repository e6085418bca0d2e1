// polygons.h: faces of any number of corners, as files hold them, and the triangles that they become.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "pbnbrdf/render/mesh.h"

namespace pbnbrdf {

struct PolygonMesh {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};  // no normal

  struct Corner {
    std::uint32_t position, normal;  // indices, in range; the normal may be kNone
  };

  std::vector<Vec3> positions, normals;
  std::vector<Corner> corners;  // of all faces, one after the other
  std::vector<std::size_t>
      face_ends;  // where each face ends in `corners`; it has at least 3 of them
};

// Their errors don't name the file.
PolygonMesh ParseObj(std::string_view text);
PolygonMesh ParsePly(std::string_view bytes);

// Convex faces become fans of triangles, concave ones are cut ear by ear (Meisters 1975). Where some corners have
// normals, those that have none, or one of length 0, get the normal of their face. Repeated corners are left out,
// and the triangles that they would make counted. Throws Error "vertex N: ..." if a coordinate isn't finite or is too
// large, "face N: ..." if a concave face has too many corners.
TriangleMesh Triangulated(const PolygonMesh& polygons);

}  // namespace pbnbrdf
