#include "tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace pbnbrdf {
namespace {

// In pixels of the image.
struct Bounds {
  double left, right, top, bottom;

  bool Touches(const PixelBlock& block) const {
    return left <= block.x + block.width && right >= block.x && top <= block.y + block.height &&
           bottom >= block.y;
  }
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Bounds kEverywhere = {-kInfinity, kInfinity, -kInfinity, kInfinity};
constexpr Bounds kNowhere = {kInfinity, -kInfinity, kInfinity, -kInfinity};

// Of the points' convex hull.
Bounds BoundsOf(std::span<const Vec3> points, const PinholeCamera& camera) {
  Bounds bounds = kNowhere;
  for (const Vec3& point : points) {
    Projection at;
    if (!camera.Project(point, &at)) return kEverywhere;
    bounds.left = std::min(bounds.left, at.x - at.slack);
    bounds.right = std::max(bounds.right, at.x + at.slack);
    bounds.top = std::min(bounds.top, at.y - at.slack);
    bounds.bottom = std::max(bounds.bottom, at.y + at.slack);
  }
  return bounds;
}

std::vector<Bounds> BoundsOfMeshes(const Scene& scene, const PinholeCamera& camera) {
  std::vector<Bounds> all;
  for (const Shape& shape : scene.shapes) {
    if (!shape.sphere) all.push_back(BoundsOf(shape.mesh.mesh.positions, camera));
  }
  for (const auto& [center, x, y, radiance] : scene.rectangle_lights) {
    const std::array<Vec3, 4> corners = {center - x - y, center + x - y, center + x + y,
                                         center - x + y};
    all.push_back(BoundsOf(corners, camera));
  }
  return all;
}

// Of two vectors that aren't zero, in radians.
double Angle(const Vec3& a, const Vec3& b) { return std::atan2(Length(Cross(a, b)), Dot(a, b)); }

// Directions from the camera through the middle of a block and its corners, with slack.
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

// A sphere or an ellipsoid as the camera sees it: a cone in the space where it is the unit sphere.
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

  // Both the sphere and the block are taken for the cones about them.
  bool Touches(const Pyramid& block) const {
    if (!outside_) return true;
    const Vec3 middle = to_unit_.Vector(block.middle);
    double spread = 0.0;
    for (const Vec3& corner : block.corners) {
      spread = std::max(spread, Angle(middle, to_unit_.Vector(corner)));
    }
    // The cone about the corners has all that is between them if it is less than a half space.
    return !(spread < 0.5 * std::numbers::pi && Angle(middle, axis_) > spread + half_angle_);
  }

 private:
  Affine to_unit_;
  Vec3 axis_;  // from the camera to the center
  bool outside_;
  double half_angle_ = 0.0;
};

std::vector<Silhouette> SilhouettesOf(const Scene& scene) {
  std::vector<Silhouette> silhouettes;
  for (const Shape& shape : scene.shapes) {
    if (shape.sphere) silhouettes.emplace_back(*shape.sphere, scene.camera.origin);
  }
  return silhouettes;
}

}  // namespace

std::vector<PixelBlock> Cut(const PixelBlock& block, int size) {
  std::vector<PixelBlock> blocks;
  for (int y = 0; y < block.height; y += size) {
    for (int x = 0; x < block.width; x += size) {
      blocks.push_back({block.x + x, block.y + y, std::min(size, block.width - x),
                        std::min(size, block.height - y)});
    }
  }
  return blocks;
}

std::vector<Tile> TilesOf(const Scene& scene, const PinholeCamera& camera) {
  const std::vector<Bounds> meshes = BoundsOfMeshes(scene, camera);
  const std::vector<Silhouette> spheres = SilhouettesOf(scene);
  std::vector<Tile> tiles;
  for (const PixelBlock& block : Cut({0, 0, scene.film.width, scene.film.height}, kTileSize)) {
    const Pyramid pyramid = PyramidOf(block, camera);
    const bool seen = std::any_of(meshes.begin(), meshes.end(),
                                  [&](const Bounds& mesh) { return mesh.Touches(block); }) ||
                      std::any_of(spheres.begin(), spheres.end(), [&](const Silhouette& sphere) {
                        return sphere.Touches(pyramid);
                      });
    tiles.push_back({block, !seen});
  }
  return tiles;
}

}  // namespace pbnbrdf
