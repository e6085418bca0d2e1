// scene.h: what there is to see: a camera, shapes, materials and lights. problems/scenes/README.md
// describes the file. Lengths in any one unit, right-handed coordinates, +y up where that matters.
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
  Vec3 up = {0.0, 1.0, 0.0};    // not along the view
  double field_of_view = 30.0;  // across the image's width, degrees in (0, 180)
};

struct Film {
  int width = 512, height = 512;
};

struct SceneMaterial {
  std::string name;
  std::string source;            // what the caller's MaterialOpener takes (render.h)
  double scale_to_albedo = 0.0;  // as ScaleToAlbedo (brdf/scaled.h); 0: as it is
};

// Materials reflect on both sides: the normal is the one on the viewer's side.
struct SphereShape {
  Affine to_world;  // of the unit sphere about the origin; it may become an ellipsoid
};

// tangent: the x axis of the materials' frame is this, projected on the surface; of a sphere, it
// points to the east, about the sphere's own y axis.
struct MeshShape {
  TriangleMesh mesh;  // placed
  Vec3 tangent = {1.0, 0.0, 0.0};
};

struct Shape {
  std::optional<SphereShape> sphere;  // or else
  MeshShape mesh;
  int material = 0;
};

struct PointLight {
  Vec3 position;
  Rgb intensity;  // W / sr
};

struct DirectionalLight {
  Vec3 direction;  // in which it travels, of unit length
  Rgb irradiance;  // W / m^2 on what faces it
};

// A parallelogram that is seen, and emits on the side of its normal, x axis times y axis; the other
// side is black, and neither reflects.
struct RectangleLight {
  Vec3 center, x_axis, y_axis;  // half of the sides
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

// What the caller has other ideas about than the file.
struct SceneChanges {
  std::string environment = {};                     // an OpenEXR file; "": as the scene says
  std::map<std::string, std::string> sources = {};  // of materials, by name
};

// Throws Error "FILE: shapes[2].radius: must be > 0": the file and the place in it; of unknown keys
// with the nearest that is known.
Scene ReadScene(const std::string& path, const SceneChanges& changes = {});

}  // namespace pbnbrdf
