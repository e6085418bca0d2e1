// mesh_files.h: meshes from the bytes of their files; mesh.h says what is read. Errors don't name
// the file, and of a mesh that is read no more is sure than that its indices are in range.
#pragma once

#include <string_view>

#include "pbnbrdf/render/mesh.h"

namespace pbnbrdf {

TriangleMesh ParseObj(std::string_view text);
TriangleMesh ParsePly(std::string_view bytes);

}  // namespace pbnbrdf
