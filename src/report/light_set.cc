#include "report/light_set.h"

#include <cmath>
#include <numbers>

#include "base/pi.h"
#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {
namespace {

constexpr int kSkyRows = 256;  // over theta, twice as many over phi; the sun is a few of them wide

std::vector<Vec3> FibonacciLattice(int count) {
  std::vector<Vec3> points;
  for (int n = 0; n < count; ++n) {
    const double y = 1.0 - (2.0 * n + 1.0) / count, r = std::sqrt(1.0 - y * y);
    const double phi = 2.0 * kPi * n / std::numbers::phi;
    points.push_back({r * std::cos(phi), y, r * std::sin(phi)});
  }
  return points;
}

std::size_t Nearest(const std::vector<Vec3>& points, const Vec3& direction) {
  std::size_t nearest = 0;
  for (std::size_t n = 1; n < points.size(); ++n) {
    if (Dot(points[n], direction) > Dot(points[nearest], direction)) nearest = n;
  }
  return nearest;
}

}  // namespace

std::vector<DistantLight> LightSet(const std::function<Rgb(const Vec3&)>& radiance, int count) {
  const std::vector<Vec3> points = FibonacciLattice(count);
  std::vector<Rgb> irradiance(points.size());
  std::vector<Vec3> towards(points.size());
  for (int row = 0; row < kSkyRows; ++row) {
    const double theta = kPi * (row + 0.5) / kSkyRows;
    const double solid_angle = std::sin(theta) * (kPi / kSkyRows) * (kPi / kSkyRows);
    for (int column = 0; column < 2 * kSkyRows; ++column) {
      const Vec3 local = FromSpherical(theta, kPi * (column + 0.5) / kSkyRows);
      const Vec3 direction = {local.x, local.z, local.y};  // +y is up
      const std::size_t n = Nearest(points, direction);
      const Rgb light = radiance(direction);
      for (std::size_t c = 0; c < 3; ++c) irradiance[n][c] += solid_angle * light[c];
      towards[n] = towards[n] + solid_angle * Luminance(light) * direction;
    }
  }
  std::vector<DistantLight> lights;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double length = Length(towards[n]);
    if (length > 0.0) lights.push_back({(1.0 / length) * towards[n], irradiance[n]});
  }
  return lights;
}

}  // namespace pbnbrdf
