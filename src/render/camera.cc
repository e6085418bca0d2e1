#include "camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pbnbrdf {
namespace {

// Points nearer than this to the plane through the camera, relative to their distance, count as
// beside it.
constexpr double kLeastDepth = 1e-3;

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
  if (!(depth > kLeastDepth * Length(way) && depth > 10.0 * error)) return false;
  const double width2 = Dot(right_, right_);  // pixels are square: one scale for both directions
  const double scale = 0.5 * film_.width / std::sqrt(width2);
  projection->x = 0.5 * film_.width * (1.0 + Dot(way, right_) / (depth * width2));
  projection->y = 0.5 * film_.height * (1.0 - Dot(way, up_) / (depth * Dot(up_, up_)));
  // A change of the angle moves the place by 1 + tan^2 times that.
  const double secant = Length(way) / depth;
  projection->slack = 1.0 + 2.0 * scale * secant * secant * (error / depth + kSinglePrecision);
  return true;
}

}  // namespace pbnbrdf
