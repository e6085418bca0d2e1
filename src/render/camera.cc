#include "camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pbnbrdf {
namespace {

// The least depth of a point in front of the camera, relative to its distance: others are less than
// 0.06 degrees from the plane of the camera, where projections are large and inexact.
constexpr double kMinDepth = 1e-3;

// A depth must exceed its own error by this factor, so that at least its first digit is right.
constexpr double kMinDepthOverError = 10.0;

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

}  // namespace pbnbrdf
