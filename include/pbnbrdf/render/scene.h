// scene.h: a scene to render: camera, shapes, materials and lights, and the file that holds it, which
// problems/scenes/README.md describes. Lengths are in any one unit; coordinates are right-handed.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pbnbrdf/render/environment_map.h"
#include "pbnbrdf/render/mesh.h"

namespace pbnbrdf {

struct Camera {
  Vec3 origin = {0.0, 0.0, 0.0}, target = {0.0, 0.0, -1.0};
  Vec3 up = {0.0, 1.0, 0.0};    // not parallel to the view
  double field_of_view = 30.0;  // across the image's width, degrees in (0, 180)
};

struct Film {
  int width = 512, height = 512;
};

// In the same proportions; width >= 1.
Film WithWidth(const Film& film, int width);

struct SceneMaterial {
  std::string name;
  std::string source;            // for the caller's MaterialOpener (render.h)
  double scale_to_albedo = 0.0;  // as in ScaleToAlbedo (brdf/scaled.h); 0: not scaled
};

// Shapes reflect on both sides: the normal is the one on the viewer's side.
//
// The x axis of the material's frame is a tangent, projected on the surface: on a sphere it points
// east, about the sphere's own y axis.
struct SphereShape {
  Affine to_world;  // of the unit sphere about the origin, which may become an ellipsoid
};

struct MeshShape {
  TriangleMesh mesh;  // in world coordinates
  Vec3 tangent = {1.0, 0.0, 0.0};
};

struct Shape {
  std::optional<SphereShape> sphere;  // if absent, the shape is the mesh
  MeshShape mesh;
  int material = 0;
};

struct PointLight {
  Vec3 position;
  Rgb intensity;  // W / sr
};

struct DirectionalLight {
  Vec3 direction;  // in which the light travels, of unit length
  Rgb irradiance;  // W / m^2, on a surface that faces the light
};

// A visible parallelogram. It emits on the side of its normal, x axis times y axis; its back is black.
// It reflects nothing.
struct RectangleLight {
  Vec3 center, x_axis, y_axis;  // the axes are half of the sides
  Rgb radiance;                 // W / (m^2 sr)
};

struct Scene {
  Camera camera;
  Film film;
  std::vector<SceneMaterial> materials;
  std::vector<Shape> shapes;
  std::optional<EnvironmentMap> environment;
  std::vector<PointLight> point_lights;
  std::vector<DirectionalLight> directional_lights;
  std::vector<RectangleLight> rectangle_lights;
};

// Replaces parts of a scene file.
struct SceneChanges {
  std::string environment = {};  // an OpenEXR file with the environment's radiance; "": no change
  std::map<std::string, std::string> sources = {};  // of materials, by name
};

// Throws Error "FILE: shapes[2].radius: must be > 0", with the place in the file. For an unknown key it
// suggests the nearest known one.
Scene ReadScene(const std::string& path, const SceneChanges& changes = {});

// The same of a text that is already in memory; files that it names are in `folder`.
Scene ParseScene(const std::string& text, const std::string& folder,
                 const SceneChanges& changes = {});

}  // namespace pbnbrdf
