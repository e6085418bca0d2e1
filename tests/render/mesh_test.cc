// OBJ and PLY files, whole and damaged; affine maps.
#include "pbnbrdf/render/mesh.h"

#include <cstring>

#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

class Mesh : public testing::Test {
 protected:
  TriangleMesh Read(const std::string& bytes) const {
    WriteBytes(folder_ / "mesh", bytes);
    return ReadMesh(folder_ / "mesh");
  }
  std::string Error(const std::string& bytes) const {
    return ErrorOf([&] { Read(bytes); });
  }

  TemporaryFolder folder_;
};

void ExpectNear(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  EXPECT_LE(Length(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
}

const std::string kObj =
    "# a square and a triangle\n"
    "mtllib none.mtl\n"
    "v 0 0 0\nv 2 0 0 1.0\nv 2 1 0\nv 0 1 0\n"
    "vt 0 0\nvn 0 0 1\nvn 0 0 2\n"
    "g first\nusemtl red\n"
    "f 1/1/1 2/1/1 3//1 4//2\n"
    "f -4//-2 2//1 -2//1\n";

TEST_F(Mesh, Obj) {
  const TriangleMesh mesh = Read(kObj);
  ASSERT_EQ(mesh.triangles.size(), 3u);
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.normals.size(), 4u);
  const std::vector<std::array<double, 3>> expected = {{0, 0, 1}, {2, 0, 1}, {2, 1, 1},
                                                       {0, 0, 1}, {2, 1, 1}, {0, 1, 2},
                                                       {0, 0, 1}, {2, 0, 1}, {2, 1, 1}};
  for (int k = 0; k < 9; ++k) {  // x, y and the normal's z of each corner
    const std::uint32_t vertex = mesh.triangles[k / 3][k % 3];
    EXPECT_EQ(mesh.positions[vertex].x, expected[k][0]);
    EXPECT_EQ(mesh.positions[vertex].y, expected[k][1]);
    EXPECT_EQ(mesh.normals[vertex].z, expected[k][2]);
  }
  EXPECT_TRUE(Read("v 0 0 0\nv 1 0 0\r\nv 0 1 0\nvn 0 0 1\nf 1//1 2 3\n").normals.empty());
}

TEST_F(Mesh, ObjErrorsNameTheLine) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(Error("v 0 0\nf 1 1 1\n"), HasSubstr("mesh: line 1: 'v' has 2 numbers"));
  EXPECT_THAT(Error("v 0 0 nan\n"), HasSubstr("line 1: z: 'nan' is not a finite number"));
  EXPECT_THAT(Error(three + "f 1 2\n"), HasSubstr("line 4: a face of 2 corners"));
  EXPECT_THAT(Error(three + "f 1 2 4\n"), HasSubstr("line 4: vertex 4 of 3"));
  EXPECT_THAT(Error(three + "f 1 2 0\n"), HasSubstr("line 4: vertex 0 of 3"));
  EXPECT_THAT(Error(three + "f -4 2 1\n"), HasSubstr("line 4: vertex -4 of 3"));
  EXPECT_THAT(Error(three + "f 1 2 x\n"), HasSubstr("line 4: vertex: 'x' is not a whole number"));
  EXPECT_THAT(Error(three + "f 1//1 2//1 3//1\n"), HasSubstr("line 4: normal 1 of 0"));
  EXPECT_THAT(Error(three + "f 1 2 2\n"), HasSubstr("triangle 1: has no area"));
  EXPECT_THAT(Error("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), HasSubstr("triangle 1: has no area"));
  EXPECT_THAT(Error("v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("vertex 2: a coordinate"));
  EXPECT_THAT(Error(three + "vn 0 0 0\nf 1//1 2//1 3//1\n"), HasSubstr("its normal"));
  EXPECT_THAT(Error(""), HasSubstr("no faces"));
  EXPECT_THAT(Error(three), HasSubstr("no faces"));
  EXPECT_THAT(Error(three + "f 1 2 3"), HasSubstr("line 4: cut off"));
  EXPECT_THAT(ErrorOf([&] { ReadMesh(folder_ / "none.obj"); }),
              HasSubstr("none.obj: no such file"));
}

const std::string kPlyText =
    "ply\nformat ascii 1.0\ncomment by hand\n"
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "element other 2\nproperty list uchar int many\n"
    "element face 1\nproperty list uchar int vertex_indices\nproperty float quality\n"
    "end_header\n"
    "0 0 0 255\n2 0 0 1\n2 1 0 1\n0 1 0.5 1\n"
    "0\n2 7 8\n"
    "4 0 1 2 3 0.5\n";

TEST_F(Mesh, PlyText) {
  const TriangleMesh mesh = Read(kPlyText);
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_THAT(mesh.triangles, testing::ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  ASSERT_EQ(mesh.positions.size(), 4u);
  ExpectNear(mesh.positions[3], {0.0, 1.0, 0.5});
  EXPECT_TRUE(mesh.normals.empty());
}

template <typename T>
std::string Bytes(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

std::string BinaryPly() {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\n"
      "property float y\nproperty float32 z\nproperty float nx\nproperty float ny\n"
      "property float nz\nelement face 1\nproperty uchar flags\n"
      "property list uint8 uint vertex_index\nend_header\n";
  for (int k = 0; k < 3; ++k) {
    ply += Bytes(k == 1 ? 0.1 : 0.0) + Bytes(k == 2 ? 0.5f : 0.0f) + Bytes(3.0f);
    ply += Bytes(0.0f) + Bytes(0.6f) + Bytes(0.8f);
  }
  return ply + Bytes<std::uint8_t>(9) + Bytes<std::uint8_t>(3) + Bytes(0u) + Bytes(1u) + Bytes(2u);
}

TEST_F(Mesh, PlyBinary) {
  const TriangleMesh mesh = Read(BinaryPly());
  ASSERT_EQ(mesh.triangles.size(), 1u);
  ASSERT_EQ(mesh.normals.size(), 3u);
  ExpectNear(mesh.positions[1], {0.1, 0.0, 3.0});
  ExpectNear(mesh.positions[2], {0.0, 0.5, 3.0});
  ExpectNear(mesh.normals[2], {0.0, 0.6, 0.8}, 1e-7);
}

TEST_F(Mesh, EveryTruncationOfAPlyIsRefused) {
  for (const std::string& whole : {kPlyText, BinaryPly()}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_NE(Error(whole.substr(0, size)), "") << "the first " << size << " bytes";
    }
  }
  EXPECT_THAT(Error(BinaryPly().substr(0, BinaryPly().size() - 1)), HasSubstr("face 1: truncated"));
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST_F(Mesh, PlyErrors) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return Error(Replaced(kPlyText, from, to));
  };
  EXPECT_THAT(error("ascii", "binary_big_endian"), HasSubstr("binary_big_endian isn't ascii or"));
  EXPECT_THAT(error("format ascii 1.0\n", ""), HasSubstr("no format"));
  EXPECT_THAT(error("property float y", "property float v"), HasSubstr("x, y and z once each"));
  EXPECT_THAT(error("vertex_indices", "corners"), HasSubstr("the list vertex_indices once"));
  EXPECT_THAT(error("property float x", "property real x"), HasSubstr("real is not one of char"));
  EXPECT_THAT(error("element vertex 4", "element vertex -4"), HasSubstr("-4 of them"));
  EXPECT_THAT(error("element vertex 4", "element vertex 4000000000"), HasSubstr("truncated"));
  EXPECT_THAT(error("element other 2", "elements other 2"), HasSubstr("isn't known"));
  EXPECT_THAT(error("2 0 0 1", "2 0 inf 1"), HasSubstr("vertex 2: value: 'inf' is not"));
  EXPECT_THAT(error("4 0 1 2 3", "4 0 1 2 4"), HasSubstr("vertex index 4 of 4"));
  EXPECT_THAT(error("4 0 1 2 3", "4 0 1 2 -1"), HasSubstr("vertex index -1"));
  EXPECT_THAT(error("4 0 1 2 3", "2 0 1"), HasSubstr("face 1: a face of 2 corners"));
  EXPECT_THAT(error("4 0 1 2 3", "4000000 0 1 2 3"), HasSubstr("truncated: a list of 4e+06"));
  EXPECT_THAT(error("4 0 1 2 3", "4 0 1 1 3"), HasSubstr("triangle 1: has no area"));
  std::string binary = BinaryPly();
  const float nan = NAN;
  std::memcpy(&binary[binary.find("end_header\n") + 11 + 8], &nan, 4);
  EXPECT_THAT(Error(binary), HasSubstr("vertex 1: a coordinate isn't finite"));
}

TEST(Affine, InverseNormalsAndComposition) {
  const Affine map =
      Compose(Affine::Translation({1.0, 2.0, 3.0}),
              Compose(Affine::Rotation({1.0, 2.0, -0.5}, 35.0), Affine::Scaling({2.0, -0.5, 3.0})));
  const Vec3 p = {0.3, -0.7, 1.9}, a = {0.2, 0.4, -0.1}, b = {-0.9, 0.3, 0.2};
  ExpectNear(map.Inverse().Point(map.Point(p)), p);
  ExpectNear(Compose(map, map.Inverse()).Point(p), p);
  // Normals stay perpendicular to what they were perpendicular to.
  const Vec3 n = map.Normal(Cross(a, b));
  EXPECT_NEAR(Dot(n, map.Vector(a)), 0.0, 1e-14);
  EXPECT_NEAR(Dot(n, map.Vector(b)), 0.0, 1e-14);
  EXPECT_NEAR(Dot(n, map.Vector(Cross(a, b))), Dot(Cross(a, b), Cross(a, b)), 1e-14);
  ExpectNear(Affine::Rotation({0.0, 0.0, 2.0}, 90.0).Vector({1.0, 0.0, 0.0}), {0.0, 1.0, 0.0});
  ExpectNear(Affine::Rotation({0.0, 3.0, 0.0}, 90.0).Vector({0.0, 0.0, 1.0}), {1.0, 0.0, 0.0});
}

TEST(Affine, AReflectedMeshKeepsItsOutside) {
  TriangleMesh mesh;
  mesh.positions = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  mesh.triangles = {{{0, 1, 2}}};
  const TriangleMesh mirrored = Transformed(mesh, Affine::Scaling({-1.0, 1.0, 1.0}));
  const auto [i, j, k] = mirrored.triangles[0];
  const auto& p = mirrored.positions;
  EXPECT_GT(Cross(p[j] - p[i], p[k] - p[i]).z, 0.0);
}

}  // namespace
}  // namespace pbnbrdf
