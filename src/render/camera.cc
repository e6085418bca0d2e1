#include "camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace pbnbrdf {
namespace {

// The least depth of a point in front of the camera, relative to its distance: others are less than
// 0.06 degrees from the plane of the camera, where projections are large and inexact.
constexpr double kMinDepth = 1e-3;

// A depth must exceed its own error by this factor, so that at least its first digit is right.
constexpr double kMinDepthOverError = 10.0;

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

PinholeCamera::PinholeCamera(const Camera& camera, const Film& film)
    : film_(film), origin_(camera.origin), forward_(Normalized(camera.target - camera.origin)) {
  const double half_width = std::tan(camera.field_of_view * std::numbers::pi / 360.0);
  const double half_height = half_width * film.height / film.width;
  const Vec3 right = Normalized(Cross(forward_, camera.up));
  right_ = half_width * right;
  up_ = half_height * Cross(right, forward_);
}

Ray PinholeCamera::RayThrough(double x, double y) const {
  const double across = 2.0 * x / film_.width - 1.0;
  const double down = 2.0 * y / film_.height - 1.0;
  return {origin_, Normalized(forward_ + across * right_ - down * up_)};
}

double PinholeCamera::Slack() const {
  const double width2 = Dot(right_, right_), secant2 = 1.0 + width2 + Dot(up_, up_);
  return 1.0 + film_.width / std::sqrt(width2) * secant2 * kSinglePrecision;
}

bool PinholeCamera::Project(const Vec3& point, Projection* projection) const {
  const Vec3 way = point - origin_;
  const double depth = Dot(way, forward_);
  const double error = kSinglePrecision * (LargestCoordinate(point) + LargestCoordinate(origin_));
  if (!(depth > kMinDepth * Length(way) && depth > kMinDepthOverError * error)) return false;
  const double width2 = Dot(right_, right_);  // pixels are square, so that heights have its scale
  const double scale = 0.5 * film_.width / std::sqrt(width2);
  projection->x = 0.5 * film_.width * (1.0 + Dot(way, right_) / (depth * width2));
  projection->y = 0.5 * film_.height * (1.0 - Dot(way, up_) / (depth * Dot(up_, up_)));
  // d tan(a) / da = 1 / cos^2(a).
  const double secant = Length(way) / depth;
  projection->slack = 1.0 + 2.0 * scale * secant * secant * (error / depth + kSinglePrecision);
  return true;
}

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
