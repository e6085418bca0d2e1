#include "pbnbrdf/render/environment_map.h"

#include <algorithm>
#include <cmath>

#include "base/pi.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/luminance.h"
#include "sky.h"

namespace pbnbrdf {
namespace {

// Chooses an interval between running sums in proportion to its length, and sets *within, in [0, 1),
// to the place in it. An empty interval is never chosen, whatever the rounding.
int SampleInterval(const double* sums, int count, double u, double* within) {
  const double at = u * sums[count - 1];
  int chosen = static_cast<int>(std::upper_bound(sums, sums + count - 1, at) - sums);
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
  return EnvironmentMap(ConstantImage(radiance), 0.0, 1.0);
}

EnvironmentMap::Texel EnvironmentMap::TexelAt(const Vec3& direction) const {
  const double phi = std::atan2(direction.x, -direction.z) + rotation_;
  const double u = phi / (2.0 * kPi);
  const int width = radiance_.width, height = radiance_.height;
  const int x = std::min(static_cast<int>((u - std::floor(u)) * width), width - 1);
  // acos rounds; the rows' edges decide, as they do in Sample.
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

double EnvironmentMap::PdfOf(const Texel& texel) const {
  // The texel's probability over its solid angle, in which the height in cos theta cancels.
  const double d_phi = 2.0 * kPi / radiance_.width;
  return Luminance(RadianceOf(texel)) / (total_ * d_phi);
}

double EnvironmentMap::Pdf(const Vec3& direction) const {
  return IsBlack() ? 0.0 : PdfOf(TexelAt(direction));
}

Vec3 EnvironmentMap::Sample(const std::array<double, 2>& u, double* pdf, Rgb* radiance) const {
  const int width = radiance_.width;
  double across, down;
  const int y = SampleInterval(rows_.data(), radiance_.height, u[1], &down);
  const int x =
      SampleInterval(&columns_[std::size_t(y) * std::size_t(width)], width, u[0], &across);
  *pdf = PdfOf({x, y});
  *radiance = RadianceOf({x, y});
  const double cos_theta = cos_theta_[y] + down * (cos_theta_[y + 1] - cos_theta_[y]);
  const double sin_theta = std::sqrt(std::max(0.0, 1.0 - cos_theta * cos_theta));
  const double phi = 2.0 * kPi * (x + across) / width - rotation_;
  return {sin_theta * std::sin(phi), cos_theta, -sin_theta * std::cos(phi)};
}

}  // namespace pbnbrdf
