#include "tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace pbnbrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A rectangle of the image, in pixels.
struct Bounds {
  double left = kInfinity, right = -kInfinity, top = kInfinity, bottom = -kInfinity;

  bool Overlaps(const PixelBlock& block) const {
    return left <= block.x + block.width && right >= block.x && top <= block.y + block.height &&
           bottom >= block.y;
  }
};

// The bounds of a mesh as the camera sees it.
Bounds BoundsOf(const TriangleMesh& mesh, const PinholeCamera& camera) {
  Bounds bounds;
  for (const Vec3& point : mesh.positions) {
    Projection at;
    if (!camera.Project(point, &at)) return {-kInfinity, kInfinity, -kInfinity, kInfinity};
    bounds.left = std::min(bounds.left, at.x - at.slack);
    bounds.right = std::max(bounds.right, at.x + at.slack);
    bounds.top = std::min(bounds.top, at.y - at.slack);
    bounds.bottom = std::max(bounds.bottom, at.y + at.slack);
  }
  return bounds;
}

// The angle between two vectors that are not zero, in radians.
double Angle(const Vec3& a, const Vec3& b) { return std::atan2(Length(Cross(a, b)), Dot(a, b)); }

// Directions from the camera through the middle of a block and through its corners, moved out by
// the camera's slack.
struct Pyramid {
  Vec3 middle;
  std::array<Vec3, 4> corners;
};

Pyramid PyramidOf(const PixelBlock& block, const PinholeCamera& camera) {
  const double slack = camera.Slack();
  const double left = block.x - slack, right = block.x + block.width + slack;
  const double top = block.y - slack, bottom = block.y + block.height + slack;
  const auto direction = [&](double x, double y) { return camera.RayThrough(x, y).direction; };
  return {direction(0.5 * (left + right), 0.5 * (top + bottom)),
          {direction(left, top), direction(right, top), direction(left, bottom),
           direction(right, bottom)}};
}

// A sphere or an ellipsoid as the camera sees it: a cone, in the space where it is the unit sphere.
class Silhouette {
 public:
  Silhouette(const SphereShape& sphere, const Vec3& camera) : to_unit_(sphere.to_world.Inverse()) {
    const auto& [x, y, z] = to_unit_.axes;
    const double error =
        kSinglePrecision * (LargestCoordinate(camera) + LargestCoordinate(sphere.to_world.origin));
    const double radius = 1.0 + error * std::sqrt(Dot(x, x) + Dot(y, y) + Dot(z, z));
    axis_ = -1.0 * to_unit_.Point(camera);
    const double distance = Length(axis_);
    outside_ = distance > radius;
    if (outside_) half_angle_ = std::asin(radius / distance) + kSinglePrecision;
  }

  // Compares the sphere's cone with a cone about the block.
  bool Overlaps(const Pyramid& block) const {
    if (!outside_) return true;
    const Vec3 middle = to_unit_.Vector(block.middle);
    double spread = 0.0;
    for (const Vec3& corner : block.corners) {
      spread = std::max(spread, Angle(middle, to_unit_.Vector(corner)));
    }
    // A cone about the corners contains the block if it is narrower than a half space.
    return !(spread < 0.5 * std::numbers::pi && Angle(middle, axis_) > spread + half_angle_);
  }

 private:
  Affine to_unit_;
  Vec3 axis_;  // from the camera to the center
  bool outside_;
  double half_angle_ = 0.0;
};

}  // namespace

std::vector<Tile> TilesOf(const Scene& scene, const PinholeCamera& camera) {
  std::vector<Bounds> meshes;
  std::vector<Silhouette> spheres;
  for (const Shape& shape : scene.shapes) {
    if (shape.sphere) {
      spheres.emplace_back(*shape.sphere, scene.camera.origin);
    } else {
      meshes.push_back(BoundsOf(shape.mesh.mesh, camera));
    }
  }
  for (const auto& [center, x, y, radiance] : scene.rectangle_lights) {
    meshes.push_back(BoundsOf(ParallelogramMesh(center, x, y), camera));
  }
  std::vector<Tile> tiles;
  for (const PixelBlock& block : Cut({0, 0, scene.film.width, scene.film.height}, kTileSize)) {
    const Pyramid pyramid = PyramidOf(block, camera);
    const auto overlaps_block = [&](const Bounds& mesh) { return mesh.Overlaps(block); };
    const auto overlaps_pyramid = [&](const Silhouette& s) { return s.Overlaps(pyramid); };
    tiles.push_back({block, std::none_of(meshes.begin(), meshes.end(), overlaps_block) &&
                                std::none_of(spheres.begin(), spheres.end(), overlaps_pyramid)});
  }
  return tiles;
}

}  // namespace pbnbrdf
