#include "pbnbrdf/render/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/luminance.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;

// The interval of running sums that u falls in, and where, in [0, 1): intervals of no length are
// never chosen, nor is what rounding leaves beyond the last.
int Choose(const double* sums, int count, double u, double* within) {
  const double at = u * sums[count - 1];
  const auto i = static_cast<int>(std::upper_bound(sums, sums + count, at) - sums);
  int chosen = std::min(i, count - 1);
  while (chosen > 0 && sums[chosen] == sums[chosen - 1]) --chosen;
  const double before = chosen > 0 ? sums[chosen - 1] : 0.0;
  *within = std::clamp((at - before) / (sums[chosen] - before), 0.0, 1.0 - 0x1p-53);
  return chosen;
}

}  // namespace

EnvironmentMap::EnvironmentMap(Image radiance, double rotation, double scale)
    : radiance_(std::move(radiance)), rotation_(rotation * kPi / 180.0) {
  const int width = radiance_.width, height = radiance_.height;
  for (std::size_t i = 0; i < radiance_.rgb.size(); ++i) {
    float& value = radiance_.rgb[i];
    const auto scaled = static_cast<float>(std::max(0.0, double(value)) * scale);
    if (!std::isfinite(value) || !std::isfinite(scaled)) {
      const std::size_t texel = i / 3;
      Fail("texel (", texel % std::size_t(width), ", ", texel / std::size_t(width), ") is ", value,
           ", scaled ", scaled, "; must be finite");
    }
    value = scaled;
  }
  for (int y = 0; y <= height; ++y) cos_theta_.push_back(std::cos(kPi * y / height));
  for (int y = 0; y < height; ++y) {
    double row = 0.0;
    for (int x = 0; x < width; ++x) {
      row += Luminance(RadianceOf({x, y})) * (cos_theta_[y] - cos_theta_[y + 1]);
      columns_.push_back(row);
    }
    total_ += row;
    rows_.push_back(total_);
  }
}

EnvironmentMap EnvironmentMap::Constant(const Rgb& radiance) {
  Image texel(1, 1);
  for (int c = 0; c < 3; ++c) texel.rgb[c] = static_cast<float>(radiance[c]);
  return EnvironmentMap(std::move(texel), 0.0, 1.0);
}

EnvironmentMap::Texel EnvironmentMap::TexelAt(const Vec3& direction) const {
  const double phi = std::atan2(direction.x, -direction.z) + rotation_;
  const double u = phi / (2.0 * kPi);
  const int width = radiance_.width, height = radiance_.height;
  const int x = std::min(static_cast<int>((u - std::floor(u)) * width), width - 1);
  // theta only up to rounding: the edges that the density knows decide.
  const double c = std::clamp(direction.y, -1.0, 1.0);
  int y = std::min(static_cast<int>(std::acos(c) / kPi * height), height - 1);
  while (y > 0 && c > cos_theta_[y]) --y;
  while (y + 1 < height && c <= cos_theta_[y + 1]) ++y;
  return {x, y};
}

Rgb EnvironmentMap::Radiance(const Vec3& direction) const { return RadianceOf(TexelAt(direction)); }

Rgb EnvironmentMap::RadianceOf(const Texel& texel) const {
  const float* rgb = radiance_.pixel(texel.x, texel.y);
  return {rgb[0], rgb[1], rgb[2]};
}

double EnvironmentMap::Density(const Texel& texel) const {
  // The probability of the texel over its solid angle; the latter's height cancels.
  const double d_phi = 2.0 * kPi / radiance_.width;
  return Luminance(RadianceOf(texel)) / (total_ * d_phi);
}

double EnvironmentMap::Pdf(const Vec3& direction) const {
  return IsBlack() ? 0.0 : Density(TexelAt(direction));
}

Vec3 EnvironmentMap::Sample(const std::array<double, 2>& u, double* pdf, Rgb* radiance) const {
  const int width = radiance_.width;
  double across, down;
  const int y = Choose(rows_.data(), radiance_.height, u[1], &down);
  const int x = Choose(&columns_[std::size_t(y) * std::size_t(width)], width, u[0], &across);
  *pdf = Density({x, y});
  *radiance = RadianceOf({x, y});
  const double cos_theta = cos_theta_[y] + down * (cos_theta_[y + 1] - cos_theta_[y]);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  const double phi = 2.0 * kPi * (x + across) / width - rotation_;
  return {sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)};
}

}  // namespace pbnbrdf
