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
}

// x, y, z of each corner of each triangle.
std::vector<Vec3> Corners(const TriangleMesh& mesh) {
  std::vector<Vec3> corners;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) corners.push_back(mesh.positions[vertex]);
  }
  return corners;
}

// Of triangles in the plane z = 0, positive if seen counterclockwise; adds up the sizes too if they overlap.
double Area(const TriangleMesh& mesh) {
  const std::vector<Vec3> p = Corners(mesh);
  double area = 0.0;
  for (std::size_t k = 0; k < p.size(); k += 3) {
    const double z = Cross(p[k + 1] - p[k], p[k + 2] - p[k]).z / 2.0;
    EXPECT_GT(z, 0.0);
    area += z;
  }
  return area;
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(Mesh, ObjIsReadWhateverWroteIt) {
  const std::vector<Vec3> square = Corners(Read(kSquare + "f 1 2 3 4\n"));
  ASSERT_EQ(square.size(), 6u);
  for (const std::string& text : {"\xef\xbb\xbf" + kSquare + "f 1 2 3 4\n", "f 1 2 3 4\n" + kSquare,
                                  kSquare + "f 1 2 \\\n 3 4 # face\n", kSquare + "f 1 2\\\r\n3 4",
                                  kSquare + "f 1 2 3 4", "# in C:\\\n" + kSquare + "f 1 2 3 4"}) {
    EXPECT_EQ(Corners(Read(text)), square) << text;
  }
}

TEST_F(Mesh, CornersWithoutNormalGetThatOfTheirFace) {
  const TriangleMesh mesh =
      Read(kSquare + "vn 0 1 1\nvn 0 0 0\nf 1//1 2 3\nf 1 3//2 4\nf 4//1 1//1 2//1\n");
  ASSERT_EQ(mesh.triangles.size(), 3u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  const auto normal = [&](int triangle, int corner) {
    return Normalized(mesh.normals[mesh.triangles[triangle][corner]]);
  };
  const Vec3 own = Normalized({0.0, 1.0, 1.0}), flat = {0.0, 0.0, 1.0};
  ExpectNear(normal(0, 0), own);
  for (int corner : {1, 2}) ExpectNear(normal(0, corner), flat);
  for (int corner : {0, 1, 2}) ExpectNear(normal(1, corner), flat);
  for (int corner : {0, 1, 2}) ExpectNear(normal(2, corner), own);
  EXPECT_TRUE(Read(kSquare + "vn 0 0 0\nf 1//1 2//1 3//1\n").normals.empty());
}

TEST_F(Mesh, TrianglesWithoutAreaAreLeftOutAndCounted) {
  const std::string face = kSquare + "v 0.5 0 0\nv 0 0 0\nf 1 2 3 4\n";
  const std::pair<const char*, std::size_t> kMore[] = {
      {"", 0},          {"f 1 1 2\n", 1},   {"f 1 5 2\n", 1},
      {"f 1 6 2\n", 1}, {"f 1 1 1 1\n", 2}, {"f 1 2 1 2\n", 2}};
  for (const auto& [more, count] : kMore) {
    const TriangleMesh mesh = Read(face + more);
    EXPECT_EQ(mesh.left_out, count) << more;
    EXPECT_EQ(mesh.triangles.size(), 2u) << more;
  }
  const TriangleMesh five = Read(kSquare + "v 0.5 0 0\nf 1 5 2 3 4\n");
  EXPECT_DOUBLE_EQ(Area(five), 1.0);
  const TriangleMesh pole = Read(kSquare + "f 1 1 2 3\nf 1 3 4 1\n");
  EXPECT_DOUBLE_EQ(Area(pole), 1.0);
  EXPECT_EQ(pole.left_out, 2u);
}

// A polygon of which each point is seen from (0.1, -0.2), as an OBJ file of one face.
struct RandomPolygon {
  RandomPolygon(std::mt19937_64* random, int corners) {
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    std::string vertices, face = "f";
    for (int k = 0; k < corners; ++k) {
      const double r = radius(*random), phi = 2.0 * kPi * k / corners;
      points.push_back({0.1 + r * std::cos(phi), -0.2 + r * std::sin(phi), 0.0});
      vertices += StrCat("v ", FormatFullPrecision(points[k].x), " ",
                         FormatFullPrecision(points[k].y), " 0\n");
      face += StrCat(" ", k + 1);
    }
    obj = vertices + face;
  }

  // By the shoelace formula.
  double Area() const {
    double area = 0.0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      area += Cross(points[k], points[(k + 1) % points.size()]).z / 2.0;
    }
    return area;
  }

  std::vector<Vec3> points;
  std::string obj;
};

TEST_F(Mesh, ConcaveFacesAreCoveredOnce) {
  std::mt19937_64 random(7);
  for (int k = 0; k < 200; ++k) {
    const RandomPolygon polygon(&random, 4 + k % 30);
    const TriangleMesh mesh = Read(polygon.obj);
    EXPECT_EQ(mesh.triangles.size(), polygon.points.size() - 2);
    EXPECT_NEAR(Area(mesh), polygon.Area(), 1e-12) << polygon.obj;
  }
  EXPECT_THAT(Error(RandomPolygon(&random, 2000).obj),
              HasSubstr("face 1: is concave and has 2000 corners"));
  // Sides that cross have no right answer; there is one all the same.
  EXPECT_FALSE(
      Read("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 2 0\nv 2 2 0\nf 1 2 3 4 5\n").triangles.empty());
}

TEST_F(Mesh, FilesThatUsersHadTroubleWith) {
  PBNBRDF_REFERENCE_FILE(folder, "faults");
  EXPECT_NEAR(Area(ReadMesh(folder + "/mesh_concave/L.ply")), 3.0, 1e-12);
  EXPECT_NEAR(Area(ReadMesh(folder + "/mesh_concave/L_from_tip.obj")), 3.0, 1e-12);
  EXPECT_NEAR(Area(ReadMesh(folder + "/mesh_concave/star.obj")), 1.1756, 5e-5);
  for (const auto& file : std::filesystem::directory_iterator(folder + "/mesh_degenerate")) {
    EXPECT_DOUBLE_EQ(Area(ReadMesh(file.path())), 1.0) << file.path();
  }
  const TriangleMesh all = ReadMesh(folder + "/mesh_normals/all_normals.obj");
  const TriangleMesh without = ReadMesh(folder + "/mesh_normals/floor_without.obj");
  ASSERT_EQ(Corners(all), Corners(without));
  for (std::size_t k = 0; k < all.triangles.size(); ++k) {
    for (int corner = 0; corner < 3; ++corner) {
      ExpectNear(Normalized(all.normals[all.triangles[k][corner]]),
                 Normalized(without.normals[without.triangles[k][corner]]), 1e-6);
    }
  }
  EXPECT_EQ(Corners(ReadMesh(folder + "/mesh_normals/pole_quads.obj")).size(), Corners(all).size());
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
  EXPECT_THAT(Error(three + "f 1 2 2\n"), HasSubstr("no triangle has an area"));
  EXPECT_THAT(Error("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), HasSubstr("no triangle has an area"));
  EXPECT_THAT(Error("v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("vertex 2: a coordinate"));
  EXPECT_THAT(Error(""), HasSubstr("no faces"));
  EXPECT_THAT(Error(three), HasSubstr("no faces"));
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

// Bytes as this machine has them, or the other way round.
std::string BinaryPly(bool swapped = false) {
  const auto bytes = [&](auto value) {
    std::string text = Bytes(value);
    if (swapped) std::reverse(text.begin(), text.end());
    return text;
  };
  std::string ply = "ply\nformat binary_" + std::string(swapped ? "big" : "little") +
                    "_endian 1.0\nelement vertex 3\nproperty double x\n"
                    "property float y\nproperty float32 z\nproperty float nx\nproperty float ny\n"
                    "property float nz\nelement face 1\nproperty uchar flags\n"
                    "property list uint8 uint vertex_index\nend_header\n";
  for (int k = 0; k < 3; ++k) {
    ply += bytes(k == 1 ? 0.1 : 0.0) + bytes(k == 2 ? 0.5f : 0.0f) + bytes(3.0f);
    ply += bytes(0.0f) + bytes(0.6f) + bytes(0.8f);
  }
  return ply + bytes(std::uint8_t{9}) + bytes(std::uint8_t{3}) + bytes(0u) + bytes(1u) + bytes(2u);
}

TEST_F(Mesh, PlyBinary) {
  for (const bool swapped : {false, true}) {
    const TriangleMesh mesh = Read(BinaryPly(swapped));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    ASSERT_EQ(mesh.normals.size(), 3u);
    ExpectNear(mesh.positions[1], {0.1, 0.0, 3.0});
    ExpectNear(mesh.positions[2], {0.0, 0.5, 3.0});
    ExpectNear(mesh.normals[2], {0.0, 0.6, 0.8}, 1e-7);
  }
}

TEST_F(Mesh, EveryTruncationOfAPlyIsRefused) {
  const std::string text = kPlyText.substr(0, kPlyText.rfind(' ') + 1);  // without its last number
  for (const std::string& whole : {text, BinaryPly(), BinaryPly(true)}) {
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
  EXPECT_THAT(error("ascii", "binary"), HasSubstr("format=binary is not one of ascii |"));
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
  EXPECT_THAT(error("4 0 1 2 3", "4 0 1 1 1"), HasSubstr("no triangle has an area"));
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
