// Any file as a mesh: it is refused, or its triangles have three finite corners each.
#include "fuzz_input.h"
#include "pbnbrdf/render/mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using pbnbrdf::Expect;
  const pbnbrdf::FuzzFile file(data, size);
  pbnbrdf::MayRefuse([&] {
    const pbnbrdf::TriangleMesh mesh = pbnbrdf::ReadMesh(file.path());
    Expect(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(),
           "there are normals for all corners, or for none");
    for (const auto& triangle : mesh.triangles) {
      for (const auto corner : triangle) {
        Expect(corner < mesh.positions.size(), "a corner is one of the vertices");
        const pbnbrdf::Vec3& p = mesh.positions[corner];
        Expect(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z),
               "a corner is finite");
      }
    }
  });
  return 0;
}
