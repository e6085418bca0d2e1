#include "pbnbrdf/render/scene.h"

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "json_value.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "sky.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kLargestFile = 64 << 20;
constexpr int kMostPixelsAcross = 32768;

// Runs what may find fault, and puts the place before the message.
template <typename Function>
auto About(const JsonValue& json, Function function) {
  try {
    return function();
  } catch (const Error& error) {
    json.Refuse(error.what());
  }
}

Camera ReadCamera(const JsonValue& json) {
  json.CheckKeys({"origin", "target", "up", "field_of_view"});
  Camera camera;
  camera.origin = json.At("origin").Vector();
  camera.target = json.At("target").Vector();
  if (json.Has("up")) camera.up = json.At("up").Direction();
  camera.field_of_view = json.At("field_of_view").Positive();
  if (!(camera.field_of_view < 180.0)) json.At("field_of_view").Refuse("must be less than 180");
  const Vec3 view = camera.target - camera.origin;
  if (!(Length(view) > 0.0)) json.At("target").Refuse("is where the camera is");
  if (!(Length(Cross(view, camera.up)) > 1e-9 * Length(view))) {
    json.Refuse("up: points along the view");
  }
  return camera;
}

Film ReadFilm(const JsonValue& json) {
  json.CheckKeys({"width", "height"});
  const Film film = {json.At("width").Whole(1, kMostPixelsAcross),
                     json.At("height").Whole(1, kMostPixelsAcross)};
  if (std::size_t(film.width) * std::size_t(film.height) > kMostPixels) {
    json.Refuse(film.width, " x ", film.height, " pixels; at most ", kMostPixels);
  }
  return film;
}

Affine ReadStep(const JsonValue& json) {
  json.CheckKeys({"translate", "scale", "rotate", "matrix"});
  const auto members = json.Members();
  if (members.size() != 1) json.Refuse("expected one of translate, scale, rotate, matrix");
  const auto& [key, value] = members[0];
  if (key == "translate") return Affine::Translation(value.Vector());
  if (key == "scale") {
    if (value.IsArray()) return Affine::Scaling(value.Vector());
    const double factor = value.Number();
    return Affine::Scaling({factor, factor, factor});
  }
  if (key == "rotate") {
    value.CheckKeys({"axis", "degrees"});
    return Affine::Rotation(value.At("axis").Direction(), value.At("degrees").Number());
  }
  const std::vector<JsonValue> rows = value.Elements();
  if (rows.size() != 3) value.Refuse("expected three rows of four numbers");
  std::array<std::array<double, 4>, 3> m;
  for (int i = 0; i < 3; ++i) {
    const std::vector<JsonValue> row = rows[i].Elements();
    if (row.size() != 4) rows[i].Refuse("expected four numbers");
    for (int j = 0; j < 4; ++j) m[i][j] = row[j].Number();
  }
  Affine map;
  for (int j = 0; j < 3; ++j) map.axes[j] = {m[0][j], m[1][j], m[2][j]};
  map.origin = {m[0][3], m[1][3], m[2][3]};
  return map;
}

// The steps of "transform" one after the other, the first of them first.
Affine ReadTransform(const JsonValue& json) {
  Affine map;
  if (!json.Has("transform")) return map;
  const JsonValue transform = json.At("transform");
  for (const JsonValue& step : transform.Elements()) map = Compose(ReadStep(step), map);
  const double size = std::max({Length(map.axes[0]), Length(map.axes[1]), Length(map.axes[2])});
  if (!std::isfinite(map.Determinant()) || !IsFinite(map.origin)) {
    transform.Refuse("isn't finite");
  }
  if (!(std::abs(map.Determinant()) > 1e-12 * size * size * size)) {
    transform.Refuse("flattens space: nothing has an area or a volume any more");
  }
  return map;
}

// x from -width / 2 to width / 2, y likewise, z = 0, seen from +z.
MeshShape ReadRectangle(const JsonValue& json, const Affine& map) {
  const double x = json.At("width").Positive() / 2.0, y = json.At("height").Positive() / 2.0;
  TriangleMesh mesh;
  mesh.positions = {{-x, -y, 0.0}, {x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}};
  mesh.triangles = {{{0, 1, 2}, {0, 2, 3}}};
  return {Transformed(mesh, map), map.axes[0]};
}

SphereShape ReadSphere(const JsonValue& json, const Affine& map) {
  const double radius = json.At("radius").Positive();
  const Vec3 center = json.Has("center") ? json.At("center").Vector() : Vec3{};
  const Affine sphere =
      Compose(map, Compose(Affine::Translation(center), Affine::Scaling({radius, radius, radius})));
  double extent = LargestCoordinate(sphere.origin);
  for (const Vec3& axis : sphere.axes) extent += LargestCoordinate(axis);
  if (!(extent <= kLargestCoordinate)) {
    json.Refuse("a coordinate isn't finite or is beyond ", kLargestCoordinate);
  }
  if (!std::isnormal(float(radius)) || !std::isnormal(sphere.Determinant())) {
    json.At("radius").Refuse("is ", radius, ", too small");
  }
  return {sphere};
}

class SceneReader {
 public:
  SceneReader(const std::string& path, const SceneChanges& changes)
      : folder_(std::filesystem::path(path).parent_path()), changes_(changes) {}

  Scene Read(const JsonValue& json) {
    json.CheckKeys({"camera", "film", "materials", "shapes", "lights"});
    scene_.camera = ReadCamera(json.At("camera"));
    if (json.Has("film")) scene_.film = ReadFilm(json.At("film"));
    if (json.Has("materials")) ReadMaterials(json.At("materials"));
    ChangeSources();
    for (const JsonValue& shape : json.At("shapes").Elements()) ReadShape(shape);
    if (json.Has("lights")) {
      for (const JsonValue& light : json.At("lights").Elements()) ReadLight(light);
    }
    if (!scene_.environment && !changes_.environment.empty()) {
      scene_.environment = EnvironmentMap(ReadExr(changes_.environment), 0.0, 1.0);
    }
    return std::move(scene_);
  }

 private:
  void ReadMaterials(const JsonValue& json) {
    for (const auto& [name, value] : json.Members()) {
      value.CheckKeys({"source", "scale_to_albedo"});
      SceneMaterial material = {name, SourceOf(value.At("source"))};
      if (value.Has("scale_to_albedo")) {
        material.scale_to_albedo = value.At("scale_to_albedo").Positive();
      }
      scene_.materials.push_back(material);
    }
  }

  std::vector<std::string> MaterialNames() const {
    std::vector<std::string> names;
    for (const SceneMaterial& material : scene_.materials) names.push_back(material.name);
    return names;
  }

  // The material's number, or a suggestion in *nearest; -1: there is none of that name.
  int FindMaterial(const std::string& name, std::string* nearest) const {
    const std::vector<std::string> names = MaterialNames();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<int>(found - names.begin());
    *nearest = names.empty() ? "the scene has no materials"
                             : "did you mean '" + Nearest(names, name) + "'?";
    return -1;
  }

  void ChangeSources() {
    for (const auto& [name, source] : changes_.sources) {
      std::string nearest;
      const int material = FindMaterial(name, &nearest);
      if (material < 0) Fail("materials: there is no '", name, "'; ", nearest);
      scene_.materials[material].source = source;
    }
  }

  int ReadMaterialName(const JsonValue& json) const {
    std::string nearest;
    const int material = FindMaterial(json.Text(), &nearest);
    if (material < 0) json.Refuse("'", json.Text(), "' isn't known; ", nearest);
    return material;
  }

  // The known keys of each type; refuses others.
  using Types = std::vector<std::pair<std::string, std::vector<std::string>>>;
  static std::string ReadType(const JsonValue& json, const Types& types) {
    const JsonValue value = json.At("type");
    const std::string type = value.Text();
    std::vector<std::string> names;
    for (const auto& [name, keys] : types) {
      names.push_back(name);
      if (name != type) continue;
      std::vector<std::string> known = keys;
      known.push_back("type");
      json.CheckKeys(known);
      return type;
    }
    value.Refuse("'", type, "' isn't known; did you mean '", Nearest(names, type), "'?");
  }

  void ReadShape(const JsonValue& json) {
    const std::string type =
        ReadType(json, {{"sphere", {"center", "radius", "transform", "material"}},
                        {"rectangle", {"width", "height", "transform", "material"}},
                        {"mesh", {"file", "transform", "material"}}});
    const Affine map = ReadTransform(json);
    Shape shape;
    shape.material = ReadMaterialName(json.At("material"));
    if (type == "sphere") {
      shape.sphere = ReadSphere(json, map);
    } else if (type == "rectangle") {
      shape.mesh = ReadRectangle(json, map);
    } else {
      const JsonValue file = json.At("file");
      shape.mesh = {Transformed(About(file, [&] { return ReadMesh(PathOf(file)); }), map),
                    map.axes[0]};
    }
    if (!shape.sphere) About(json, [&] { CheckTriangles(shape.mesh.mesh); });
    scene_.shapes.push_back(std::move(shape));
  }

  void ReadLight(const JsonValue& json) {
    const std::string type =
        ReadType(json, {{"environment", {"file", "radiance", "sky", "rotation", "scale"}},
                        {"point", {"position", "intensity"}},
                        {"directional", {"direction", "irradiance"}},
                        {"rectangle", {"width", "height", "transform", "radiance"}}});
    if (type == "environment") {
      if (scene_.environment) json.Refuse("a second environment");
      scene_.environment = ReadEnvironment(json);
    } else if (type == "point") {
      scene_.point_lights.push_back({json.At("position").Vector(), json.At("intensity").Color()});
    } else if (type == "directional") {
      scene_.directional_lights.push_back(
          {json.At("direction").Direction(), json.At("irradiance").Color()});
    } else {
      const Affine map = ReadTransform(json);
      const MeshShape shape = ReadRectangle(json, map);
      About(json, [&] { CheckTriangles(shape.mesh); });
      scene_.rectangle_lights.push_back(
          {map.origin, (json.At("width").Number() / 2.0) * map.axes[0],
           (json.At("height").Number() / 2.0) * map.axes[1], json.At("radiance").Color()});
    }
  }

  EnvironmentMap ReadEnvironment(const JsonValue& json) const {
    if (json.Has("file") + json.Has("radiance") + json.Has("sky") != 1) {
      json.Refuse("expected one of file, radiance and sky");
    }
    const double rotation = json.Has("rotation") ? json.At("rotation").Number() : 0.0;
    const double scale = json.Has("scale") ? json.At("scale").NotNegative() : 1.0;
    return About(json, [&] { return EnvironmentMap(EnvironmentImage(json), rotation, scale); });
  }

  Image EnvironmentImage(const JsonValue& json) const {
    if (!changes_.environment.empty()) return ReadExr(changes_.environment);
    if (json.Has("file")) return ReadExr(PathOf(json.At("file")));
    if (json.Has("sky")) return SkyImage(ReadSky(json.At("sky")));
    const Rgb radiance = json.At("radiance").Color();
    Image texel(1, 1);
    for (int c = 0; c < 3; ++c) texel.rgb[c] = static_cast<float>(radiance[c]);
    return texel;
  }

  static Sky ReadSky(const JsonValue& json) {
    json.CheckKeys({"zenith", "horizon", "ground", "sun"});
    Sky sky = {json.At("zenith").Color(), json.At("horizon").Color(), json.At("ground").Color()};
    if (!json.Has("sun")) return sky;
    const JsonValue sun = json.At("sun");
    sun.CheckKeys({"direction", "radius", "radiance"});
    sky.sun_direction = sun.At("direction").Direction();
    sky.sun_radius = sun.At("radius").Positive();
    sky.sun = sun.At("radiance").Color();
    return sky;
  }

  // A file in the scene's folder, or whatever the opener makes of it.
  std::string SourceOf(const JsonValue& json) const {
    std::error_code code;
    const std::string path = PathOf(json);
    return std::filesystem::is_regular_file(path, code) ? path : json.Text();
  }

  // Relative to the scene file's folder.
  std::string PathOf(const JsonValue& json) const { return folder_ / json.Text(); }

  std::filesystem::path folder_;
  const SceneChanges& changes_;
  Scene scene_;
};

}  // namespace

Scene ReadScene(const std::string& path, const SceneChanges& changes) {
  const std::string text = ReadFile(path, kLargestFile);
  try {
    const nlohmann::ordered_json json = ParseJson(text);
    return SceneReader(path, changes).Read(JsonValue(json, ""));
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

}  // namespace pbnbrdf
