// sheen.h: the sheen of cloth [1], as KHR_materials_sheen of glTF has it.
//
// [1] A. Estevez, C. Kulla. Production Friendly Microfacet Sheen BRDF. SIGGRAPH 2017 course notes.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace pbnbrdf {

inline constexpr double kLeastSheenRoughness = 0.07;

// The lobe of a sheen_color of 1, 1/sr: fibres' normals are distributed as sin^(1 / alpha) theta_h, alpha = roughness^2,
// and shadow each other as 1 / (4 (cos_i + cos_o - cos_i cos_o)).
template <typename T>
T SheenLobe(double sin2_h, double cos_i, double cos_o, const T& roughness) {
  using std::exp;
  if (!(sin2_h > 1e-12)) return T(0.0);
  const T bounded = roughness < kLeastSheenRoughness ? T(kLeastSheenRoughness) : roughness;
  const T exponent = 1.0 / (bounded * bounded);
  const T distribution =
      (2.0 + exponent) * exp(0.5 * exponent * std::log(sin2_h)) * (0.5 * std::numbers::inv_pi);
  return distribution * (0.25 / (cos_i + cos_o - cos_i * cos_o));
}

// Its directional albedo at places that are equally far apart: [roughness][cosine], both from 0 to 1.
inline constexpr int kSheenPlaces = 17;
using SheenAlbedos = std::array<std::array<double, kSheenPlaces>, kSheenPlaces>;
const SheenAlbedos& TabulatedSheenAlbedos();

// The albedo at a cosine in [0, 1], linear between these places. It falls with the cosine.
template <typename T>
T SheenAlbedo(double cosine, const T& roughness) {
  constexpr int kCells = kSheenPlaces - 1;
  const T place = roughness * double(kCells);
  int row = 0;
  while (row + 1 < kCells && place > row + 1.0) ++row;
  const double column_place = cosine * kCells;
  const int column = std::min(static_cast<int>(column_place), kCells - 1);
  const auto at = [&](int r) {
    const auto& albedos = TabulatedSheenAlbedos()[static_cast<std::size_t>(r)];
    const double low = albedos[static_cast<std::size_t>(column)];
    return low + (albedos[static_cast<std::size_t>(column) + 1] - low) * (column_place - column);
  };
  return at(row) + (at(row + 1) - at(row)) * (place - double(row));
}

}  // namespace pbnbrdf
