#include "models/sheen.h"

#include <algorithm>

#include "pbnbrdf/brdf/reflection_geometry.h"

namespace pbnbrdf {
namespace {

constexpr int kRows = 64,
              kColumns = 64;  // of the midpoint rule over the sine squared and azimuth of wo

double AlbedoAt(double cosine, double roughness) {
  const double cos_i = std::max(cosine, 1e-3);
  const Vec3 wi = {std::sqrt(1.0 - cos_i * cos_i), 0.0, cos_i};
  double sum = 0.0;
  for (int i = 0; i < kRows; ++i) {
    const double sin2 = (i + 0.5) / kRows, cos_o = std::sqrt(1.0 - sin2);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = std::numbers::pi * (j + 0.5) / kColumns;
      const Vec3 wo = {std::sqrt(sin2) * std::cos(phi), std::sqrt(sin2) * std::sin(phi), cos_o};
      const ReflectionGeometry g({wi, wo});
      sum += SheenLobe(g.Tan2H() * g.cos_h * g.cos_h, cos_i, cos_o, roughness);
    }
  }
  // cos_o dwo = dsin2 / 2 dphi
  return std::min(1.0, sum * std::numbers::pi / (kRows * kColumns));
}

SheenAlbedos Tabulate() {
  SheenAlbedos albedos;
  for (std::size_t row = 0; row < kSheenPlaces; ++row) {
    for (std::size_t column = 0; column < kSheenPlaces; ++column) {
      albedos[row][column] =
          AlbedoAt(double(column) / (kSheenPlaces - 1), double(row) / (kSheenPlaces - 1));
    }
  }
  return albedos;
}

}  // namespace

const SheenAlbedos& TabulatedSheenAlbedos() {
  static const SheenAlbedos albedos = Tabulate();
  return albedos;
}

}  // namespace pbnbrdf
