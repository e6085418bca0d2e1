#include "pbnbrdf/render/scene.h"

#include <algorithm>
#include <filesystem>

#include "base/about.h"
#include "base/text.h"
#include "json_value.h"
#include "mesh_checks.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/image/exr.h"
#include "sky.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxSceneBytes = 64 << 20;  // a scene of 300,000 spheres
constexpr int kMaxFilmSide = 32768;  // with kMaxPixels, up to 8 times as wide as high

// Rounding alone leaves sines of 1e-16, and relative determinants likewise; what is below these bounds
// has lost most of its digits.
constexpr double kMinSine = 1e-9, kMinDeterminant = 1e-12;

// The name's index. Throws Error, with the nearest name, if it is not among them.
std::size_t IndexOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (names.empty()) Fail("'", name, "' isn't known; there are none");
  Fail("'", name, "' isn't known; did you mean '", Nearest(names, name), "'?");
}

Camera ReadCamera(const JsonValue& json) {
  json.CheckKeys({"origin", "target", "up", "field_of_view"});
  Camera camera;
  camera.origin = json.At("origin").Vector();
  camera.target = json.At("target").Vector();
  if (json.Has("up")) camera.up = json.At("up").Direction();
  camera.field_of_view = json.At("field_of_view").Number(Above(0.0));
  if (!(camera.field_of_view < 180.0)) json.At("field_of_view").Refuse("must be less than 180");
  const Vec3 view = camera.target - camera.origin;
  if (!(Length(view) > 0.0)) json.At("target").Refuse("is where the camera is");
  if (!(Length(Cross(view, camera.up)) > kMinSine * Length(view))) {
    json.Refuse("up: points along the view");
  }
  return camera;
}

Film ReadFilm(const JsonValue& json) {
  json.CheckKeys({"width", "height"});
  const Film film = {json.At("width").Whole(1, kMaxFilmSide),
                     json.At("height").Whole(1, kMaxFilmSide)};
  if (std::size_t(film.width) * std::size_t(film.height) > kMaxPixels) {
    json.Refuse(film.width, " x ", film.height, " pixels; at most ", kMaxPixels);
  }
  return film;
}

Affine ReadMatrix(const JsonValue& json) {
  const std::vector<JsonValue> rows = json.Elements();
  if (rows.size() != 3) json.Refuse("expected three rows of four numbers");
  std::array<std::array<double, 4>, 3> m;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<JsonValue> row = rows[i].Elements();
    if (row.size() != 4) rows[i].Refuse("expected four numbers");
    for (std::size_t j = 0; j < 4; ++j) m[i][j] = row[j].Number();
  }
  const auto column = [&](std::size_t j) { return Vec3{m[0][j], m[1][j], m[2][j]}; };
  return {{column(0), column(1), column(2)}, column(3)};
}

// One step of a transform.
Affine ReadStep(const JsonValue& json) {
  json.CheckKeys({"translate", "scale", "rotate", "matrix"});
  const auto members = json.Members();
  if (members.size() != 1) json.Refuse("expected one of translate, scale, rotate, matrix");
  const auto& [key, value] = members[0];
  if (key == "translate") return Affine::Translation(value.Vector());
  if (key == "matrix") return ReadMatrix(value);
  if (key == "rotate") {
    value.CheckKeys({"axis", "degrees"});
    return Affine::Rotation(value.At("axis").Direction(), value.At("degrees").Number());
  }
  if (value.IsArray()) return Affine::Scaling(value.Vector());
  const double factor = value.Number();
  return Affine::Scaling({factor, factor, factor});
}

// "transform", a list of steps; the first step comes first.
Affine ReadTransform(const JsonValue& json) {
  Affine map;
  if (!json.Has("transform")) return map;
  const JsonValue transform = json.At("transform");
  for (const JsonValue& step : transform.Elements()) map = Compose(ReadStep(step), map);
  const double size = std::max({Length(map.axes[0]), Length(map.axes[1]), Length(map.axes[2])});
  if (!std::isfinite(map.Determinant()) || !std::isfinite(LargestCoordinate(map.origin))) {
    transform.Refuse("isn't finite");
  }
  if (!(std::abs(map.Determinant()) > kMinDeterminant * size * size * size)) {
    transform.Refuse("flattens space: nothing has an area or a volume any more");
  }
  return map;
}

// "width" along x and "height" along y, about the origin.
TriangleMesh ReadRectangle(const JsonValue& json) {
  return ParallelogramMesh({}, {json.At("width").Number(Above(0.0)) / 2.0, 0.0, 0.0},
                           {0.0, json.At("height").Number(Above(0.0)) / 2.0, 0.0});
}

SphereShape ReadSphere(const JsonValue& json, const Affine& map) {
  const double radius = json.At("radius").Number(Above(0.0));
  const Vec3 center = json.Has("center") ? json.At("center").Vector() : Vec3{};
  const Affine sphere =
      Compose(map, Compose(Affine::Translation(center), Affine::Scaling({radius, radius, radius})));
  if (!(LargestCoordinate(sphere) <= kMaxCoordinate)) {
    json.Refuse("a coordinate isn't finite or is beyond ", kMaxCoordinate);
  }
  if (!std::isnormal(float(radius)) || !std::isnormal(sphere.Determinant())) {
    json.At("radius").Refuse("is ", radius, ", too small");
  }
  return {sphere};
}

class SceneReader {
 public:
  SceneReader(const std::filesystem::path& folder, const SceneChanges& changes)
      : folder_(folder), changes_(changes) {}

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
      scene_.environment = EnvironmentMap(ReadLatLongExr(changes_.environment), 0.0, 1.0);
    }
    return std::move(scene_);
  }

 private:
  void ReadMaterials(const JsonValue& json) {
    for (const auto& [name, value] : json.Members()) {
      value.CheckKeys({"source", "scale_to_albedo"});
      SceneMaterial material = {name, SourceOf(value.At("source"))};
      if (value.Has("scale_to_albedo")) {
        material.scale_to_albedo = value.At("scale_to_albedo").Number(Above(0.0));
      }
      scene_.materials.push_back(material);
    }
  }

  std::size_t MaterialIndex(const std::string& name) const {
    std::vector<std::string> names;
    for (const SceneMaterial& material : scene_.materials) names.push_back(material.name);
    return IndexOf(names, name);
  }

  void ChangeSources() {
    for (const auto& change : changes_.sources) {
      const std::size_t index = About("materials", [&] { return MaterialIndex(change.first); });
      scene_.materials[index].source = change.second;
    }
  }

  // "type", one of the given ones; refuses keys that this type does not have.
  using Types = std::vector<std::pair<std::string, std::vector<std::string>>>;
  static std::string ReadType(const JsonValue& json, const Types& types) {
    const JsonValue type = json.At("type");
    std::vector<std::string> names;
    for (const auto& [name, keys] : types) names.push_back(name);
    std::vector<std::string> keys =
        types[type.Check([&] { return IndexOf(names, type.Text()); })].second;
    keys.push_back("type");
    json.CheckKeys(keys);
    return type.Text();
  }

  void ReadShape(const JsonValue& json) {
    const std::string type =
        ReadType(json, {{"sphere", {"center", "radius", "transform", "material"}},
                        {"rectangle", {"width", "height", "transform", "material"}},
                        {"mesh", {"file", "transform", "material"}}});
    const Affine map = ReadTransform(json);
    const JsonValue material = json.At("material");
    Shape shape;
    shape.material =
        static_cast<int>(material.Check([&] { return MaterialIndex(material.Text()); }));
    if (type == "sphere") {
      shape.sphere = ReadSphere(json, map);
    } else {
      const TriangleMesh mesh =
          type == "mesh" ? ReadMeshFile(json.At("file")) : ReadRectangle(json);
      shape.mesh = {Transformed(mesh, map), map.axes[0]};
      json.Check([&] { LeaveOutSlivers(&shape.mesh.mesh); });
    }
    scene_.shapes.push_back(std::move(shape));
  }

  TriangleMesh ReadMeshFile(const JsonValue& file) const {
    return file.Check([&] { return ReadMesh(PathOf(file)); });
  }

  void ReadLight(const JsonValue& json) {
    const std::string type =
        ReadType(json, {{"environment", {"file", "radiance", "sky", "rotation", "scale"}},
                        {"point", {"position", "intensity"}},
                        {"directional", {"direction", "irradiance"}},
                        {"rectangle", {"width", "height", "transform", "radiance"}}});
    if (type == "environment") {
      if (scene_.environment) json.Refuse("a second environment; a scene has at most one");
      scene_.environment = ReadEnvironment(json);
    } else if (type == "point") {
      scene_.point_lights.push_back({json.At("position").Vector(), json.At("intensity").Color()});
    } else if (type == "directional") {
      scene_.directional_lights.push_back(
          {json.At("direction").Direction(), json.At("irradiance").Color()});
    } else {
      const Affine map = ReadTransform(json);
      TriangleMesh mesh = Transformed(ReadRectangle(json), map);
      json.Check([&] { LeaveOutSlivers(&mesh); });
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
    const double scale = json.Has("scale") ? json.At("scale").Number(AtLeast(0.0)) : 1.0;
    return json.Check([&] { return EnvironmentMap(EnvironmentImage(json), rotation, scale); });
  }

  Image EnvironmentImage(const JsonValue& json) const {
    if (!changes_.environment.empty()) return ReadLatLongExr(changes_.environment);
    if (json.Has("file")) return ReadLatLongExr(PathOf(json.At("file")));
    if (json.Has("sky")) return SkyImage(ReadSky(json.At("sky")));
    return ConstantImage(json.At("radiance").Color());
  }

  static Sky ReadSky(const JsonValue& json) {
    json.CheckKeys({"zenith", "horizon", "ground", "sun"});
    Sky sky = {json.At("zenith").Color(), json.At("horizon").Color(), json.At("ground").Color()};
    if (!json.Has("sun")) return sky;
    const JsonValue sun = json.At("sun");
    sun.CheckKeys({"direction", "radius", "radiance"});
    sky.sun_direction = sun.At("direction").Direction();
    sky.sun_radius = sun.At("radius").Number(Above(0.0));
    sky.sun = sun.At("radiance").Color();
    return sky;
  }

  // A file in the scene's folder, or else a source that only the caller's MaterialOpener knows.
  std::string SourceOf(const JsonValue& json) const {
    std::error_code code;
    const std::string path = PathOf(json);
    return std::filesystem::is_regular_file(path, code) ? path : json.Text();
  }

  // Of a file that is named relative to the scene's folder.
  std::string PathOf(const JsonValue& json) const { return folder_ / json.Text(); }

  std::filesystem::path folder_;
  const SceneChanges& changes_;
  Scene scene_;
};

}  // namespace

Scene ReadScene(const std::string& path, const SceneChanges& changes) {
  const std::string text = ReadFile(path, kMaxSceneBytes);
  return About(
      path, [&] { return ParseScene(text, std::filesystem::path(path).parent_path(), changes); });
}

Scene ParseScene(const std::string& text, const std::string& folder, const SceneChanges& changes) {
  return SceneReader(folder, changes).Read(JsonValue::Parse(text));
}

Film WithWidth(const Film& film, int width) {
  const double height = 1.0 * film.height / film.width * width;
  return {width, std::max(1, static_cast<int>(std::lround(height)))};
}

}  // namespace pbnbrdf
