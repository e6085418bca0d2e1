// mesh_files.h: parts of ReadMesh. Their errors do not name the file.
#pragma once

#include <string_view>

#include "pbnbrdf/render/mesh.h"

namespace pbnbrdf {

// The meshes have indices in range; CheckTriangles checks the rest.
TriangleMesh ParseObj(std::string_view text);
TriangleMesh ParsePly(std::string_view bytes);

// Throws Error "triangle N: ..." or "vertex N: ..." if a triangle has no area, a normal has no length,
// or a coordinate is not finite or too large.
void CheckTriangles(const TriangleMesh& mesh);

}  // namespace pbnbrdf
