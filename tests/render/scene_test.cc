// Scene files: how they are read, and the errors of bad ones.
#include "pbnbrdf/render/scene.h"

#include "pbnbrdf/image/exr.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

const std::string kScene = R"({
  "camera": {"origin": [0, 1, 5], "target": [0, 0, 0], "field_of_view": 40},
  "film": {"width": 30, "height": 20},
  "materials": {
    "gold": {"source": "builtin:satin-gold", "scale_to_albedo": 0.9},
    "wall": {"source": "builtin:wall-plaster"}
  },
  "shapes": [
    {"type": "sphere", "center": [1, 2, 3], "radius": 0.5, "material": "gold",
     "transform": [{"scale": 2}, {"translate": [10, 0, 0]}]},
    {"type": "rectangle", "width": 4, "height": 2, "material": "wall",
     "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": -90}}]},
    {"type": "mesh", "file": "triangle.obj", "material": "gold",
     "transform": [{"matrix": [[1, 0, 0, 5], [0, 2, 0, 0], [0, 0, 1, 0]]}]}
  ],
  "lights": [
    {"type": "environment", "radiance": [1, 2, 3], "scale": 2},
    {"type": "point", "position": [0, 3, 0], "intensity": 7},
    {"type": "directional", "direction": [0, -2, 0], "irradiance": 1},
    {"type": "rectangle", "width": 2, "height": 6, "radiance": 4}
  ]
})";

class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    WriteBytes(folder_ / "triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  Scene Read(const std::string& text, const SceneChanges& changes = {}) const {
    WriteBytes(folder_ / "scene.json", text);
    return ReadScene(folder_ / "scene.json", changes);
  }
  // The error of the scene in which `to` replaces `from`, without the file's name.
  std::string Error(const std::string& from, const std::string& to,
                    const SceneChanges& changes = {}) const {
    std::string text = kScene;
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    const std::string error = ErrorOf([&] { Read(text, changes); });
    const std::string file = folder_ / "scene.json: ";
    EXPECT_THAT(error, testing::StartsWith(file));
    return error.substr(std::min(file.size(), error.size()));
  }

  TemporaryFolder folder_;
};

void ExpectNear(const Vec3& a, const Vec3& b) {
  EXPECT_LE(Length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST_F(SceneFile, SaysWhatThereIs) {
  const Scene scene = Read(kScene);
  ExpectNear(scene.camera.origin, {0.0, 1.0, 5.0});
  ExpectNear(scene.camera.up, {0.0, 1.0, 0.0});
  EXPECT_EQ(scene.camera.field_of_view, 40.0);
  EXPECT_EQ(scene.film.width, 30);
  EXPECT_EQ(scene.film.height, 20);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].source, "builtin:satin-gold");
  EXPECT_EQ(scene.materials[0].scale_to_albedo, 0.9);
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_EQ(scene.shapes[1].material, 1);
  ExpectNear(scene.shapes[0].sphere->to_world.Point({0.0, 0.0, 0.0}), {12.0, 4.0, 6.0});
  ExpectNear(scene.shapes[0].sphere->to_world.Vector({0.0, 1.0, 0.0}), {0.0, 1.0, 0.0});
  const TriangleMesh& floor = scene.shapes[1].mesh.mesh;
  ExpectNear(floor.positions[0], {-2.0, 0.0, 1.0});
  ExpectNear(floor.positions[2], {2.0, 0.0, -1.0});
  ExpectNear(Normalized(Cross(floor.positions[1] - floor.positions[0],
                              floor.positions[2] - floor.positions[0])),
             {0.0, 1.0, 0.0});
  ExpectNear(scene.shapes[2].mesh.mesh.positions[2], {5.0, 2.0, 0.0});
  EXPECT_EQ(scene.environment->Radiance({0.0, 1.0, 0.0}), (Rgb{2.0, 4.0, 6.0}));
  EXPECT_EQ(scene.point_lights.at(0).intensity, (Rgb{7.0, 7.0, 7.0}));
  ExpectNear(scene.directional_lights.at(0).direction, {0.0, -1.0, 0.0});
  ExpectNear(scene.rectangle_lights.at(0).y_axis, {0.0, 3.0, 0.0});
}

TEST_F(SceneFile, TakesEnvironmentAndSourcesFromTheCaller) {
  Image map(2, 1);
  map.rgb.assign(6, 3.0f);
  WriteExr(folder_ / "map.exr", map);
  const Scene changed =
      Read(kScene, {.environment = folder_ / "map.exr", .sources = {{"gold", "ggx:alpha=0.3"}}});
  EXPECT_EQ(changed.materials[0].source, "ggx:alpha=0.3");
  EXPECT_EQ(changed.environment->Radiance({0.0, 1.0, 0.0})[0], 6.0);  // the scale stays
  std::string text = kScene;
  const std::string constant = R"("radiance": [1, 2, 3])";
  text.replace(text.find(constant), constant.size(), R"("file": "map.exr")");
  EXPECT_EQ(Read(text).environment->Radiance({0.0, 1.0, 0.0})[0], 6.0);

  EXPECT_EQ(Error("{", "{", {.sources = {{"golt", "x"}}}),
            "materials: 'golt' isn't known; did you mean 'gold'?");
  EXPECT_THAT(Error("{", "{", {.environment = folder_ / "none.exr"}),
              HasSubstr("none.exr: no such file"));
}

TEST_F(SceneFile, MaterialsInItsFolderAreFound) {
  WriteBytes(folder_ / "gold.csv", "not read here");
  std::string text = kScene;
  text.replace(text.find("builtin:satin-gold"), 18, "gold.csv");
  EXPECT_EQ(Read(text).materials[0].source, folder_ / "gold.csv");
}

TEST_F(SceneFile, UnknownKeysAreNamedWithTheNearest) {
  EXPECT_EQ(Error("\"radius\"", "\"raduis\""),
            "shapes[0]: key \"raduis\" isn't known; did you mean \"radius\"?");
  EXPECT_EQ(Error("\"film\"", "\"flim\""), "key \"flim\" isn't known; did you mean \"film\"?");
  EXPECT_EQ(
      Error("\"scale_to_albedo\"", "\"scale_to_albdo\""),
      "materials.gold: key \"scale_to_albdo\" isn't known; did you mean \"scale_to_albedo\"?");
  EXPECT_EQ(Error("\"sphere\"", "\"spere\""),
            "shapes[0].type: 'spere' isn't known; did you mean 'sphere'?");
  EXPECT_EQ(Error("\"point\"", "\"pint\""),
            "lights[1].type: 'pint' isn't known; did you mean 'point'?");
  EXPECT_EQ(Error("\"material\": \"wall\"", "\"material\": \"wal\""),
            "shapes[1].material: 'wal' isn't known; did you mean 'wall'?");
  EXPECT_EQ(Error("\"width\": 30", "\"width\": 30, \"width\": 31"), "key \"width\" is given twice");
}

TEST_F(SceneFile, ValuesOutOfRangeAreNamedByTheirPlace) {
  EXPECT_EQ(Error("\"radius\": 0.5", "\"radius\": 0"), "shapes[0].radius: is 0; must be > 0");
  EXPECT_EQ(Error("\"radius\": 0.5", "\"radius\": -1"), "shapes[0].radius: is -1; must be > 0");
  EXPECT_EQ(Error("\"radius\": 0.5", "\"radius\": \"big\""),
            "shapes[0].radius: expected a number, found \"big\"");
  EXPECT_EQ(Error("\"radius\": 0.5, ", ""), "shapes[0]: has no \"radius\"");
  EXPECT_THAT(Error("\"radius\": 0.5", "\"radius\": 1e-60"), HasSubstr("too small"));
  EXPECT_THAT(Error("\"radius\": 0.5", "\"radius\": 1e30"), HasSubstr("shapes[0]: a coordinate"));
  EXPECT_THAT(Error("\"radius\": 0.5", "\"radius\": NaN"),
              HasSubstr("not JSON: parse error at line 9"));
  EXPECT_THAT(Error("\"radius\": 0.5", "\"radius\": 1e999"),
              HasSubstr("not JSON: number overflow"));
  EXPECT_EQ(Error("[1, 2, 3], \"radius\"", "[1, 2], \"radius\""),
            "shapes[0].center: expected three numbers, found [1,2]");
  EXPECT_EQ(Error("\"field_of_view\": 40", "\"field_of_view\": 180"),
            "camera.field_of_view: must be less than 180");
  EXPECT_EQ(Error("\"target\": [0, 0, 0]", "\"target\": [0, 1, 5]"),
            "camera.target: is where the camera is");
  EXPECT_EQ(Error("\"target\": [0, 0, 0]", "\"target\": [0, 7, 5]"),
            "camera: up: points along the view");
  EXPECT_EQ(Error("\"width\": 30", "\"width\": 2.5"),
            "film.width: is 2.5; must be a whole number from 1 to 32768");
  EXPECT_THAT(Error("\"width\": 30, \"height\": 20", "\"width\": 32768, \"height\": 32768"),
              HasSubstr("film: 32768 x 32768 pixels"));
  EXPECT_EQ(Error("0.9", "0"), "materials.gold.scale_to_albedo: is 0; must be > 0");
  EXPECT_EQ(Error("\"intensity\": 7", "\"intensity\": [1, -1, 1]"),
            "lights[1].intensity: has a channel of -1; must be >= 0");
  EXPECT_EQ(Error("\"radiance\": [1, 2, 3]", "\"radiance\": -1"),
            "lights[0].radiance: has a channel of -1; must be >= 0");
  EXPECT_EQ(Error("[0, -2, 0]", "[0, 0, 0]"),
            "lights[2].direction: must have a length that isn't 0");
  EXPECT_EQ(Error("\"radiance\": [1, 2, 3], ", ""),
            "lights[0]: expected one of file, radiance and sky");
  EXPECT_EQ(Error("\"type\": \"point\", \"position\": [0, 3, 0], \"intensity\": 7",
                  "\"type\": \"environment\", \"radiance\": 1"),
            "lights[1]: a second environment; a scene has at most one");
}

TEST_F(SceneFile, GeometryWithoutAreaIsRefused) {
  EXPECT_EQ(Error("{\"scale\": 2}", "{\"scale\": [1, 0, 1]}"),
            "shapes[0].transform: flattens space: nothing has an area or a volume any more");
  EXPECT_EQ(Error("{\"scale\": 2}", "{\"scale\": 2, \"translate\": [1, 1, 1]}"),
            "shapes[0].transform[0]: expected one of translate, scale, rotate, matrix");
  EXPECT_EQ(Error("\"axis\": [1, 0, 0]", "\"axis\": [0, 0, 0]"),
            "shapes[1].transform[0].rotate.axis: must have a length that isn't 0");
  EXPECT_EQ(Error("[0, 2, 0, 0], ", ""),
            "shapes[2].transform[0].matrix: expected three rows of four numbers");
  EXPECT_EQ(Error("[0, 2, 0, 0]", "[0, 2, 0]"),
            "shapes[2].transform[0].matrix[1]: expected four numbers");
  WriteBytes(folder_ / "line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  EXPECT_THAT(Error("triangle.obj", "line.obj"), HasSubstr("line.obj: no triangle has an area"));
  EXPECT_THAT(Error("[0, 3, 0]", "[0, 1e400, 0]"), HasSubstr("not JSON: number overflow"));
}

TEST_F(SceneFile, MissingAndBrokenFiles) {
  EXPECT_THAT(ErrorOf([&] { ReadScene(folder_ / "none.json"); }),
              HasSubstr("none.json: no such file"));
  EXPECT_THAT(
      Error("triangle.obj", "none.obj"),
      testing::AllOf(testing::StartsWith("shapes[2].file: "), HasSubstr("none.obj: no such file")));
  EXPECT_THAT(
      Error("\"radiance\": [1, 2, 3]", "\"file\": \"none.exr\""),
      testing::AllOf(testing::StartsWith("lights[0]: "), HasSubstr("none.exr: no such file")));
  for (std::size_t size = 0; size < kScene.size() - 1; size += 7) {
    EXPECT_THAT(ErrorOf([&] { Read(kScene.substr(0, size)); }), HasSubstr("not JSON: "));
  }
  EXPECT_THAT(ErrorOf([&] { Read(std::string(100000, '[')); }), HasSubstr("nested"));
  EXPECT_THAT(ErrorOf([&] { Read("[]"); }), HasSubstr("expected an object"));
  EXPECT_THAT(ErrorOf([&] { Read("{}"); }), HasSubstr("has no \"camera\""));
}

}  // namespace
}  // namespace pbnbrdf
