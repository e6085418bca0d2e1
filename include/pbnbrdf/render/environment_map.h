// environment_map.h: light from infinitely far away, by direction.
//
// A latitude-longitude image: rows are equal steps of theta from +y (the top) to -y, columns equal
// steps of phi from phi = 0 at the left edge, with the direction (sin theta sin phi, cos theta,
// -sin theta cos phi): what Mitsuba does. Radiance is constant within a texel, and so is the
// density that directions are drawn with, per solid angle: their quotient varies by the texels'
// colours only.
#pragma once

#include <array>
#include <vector>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

class EnvironmentMap {
 public:
  // radiance: W / (m^2 sr), at least one texel; negative values, which resampling leaves, count as
  // 0. It is multiplied by scale, finite and >= 0, and turned about +y, right-handed, by `rotation`
  // degrees. Throws Error, with the texel, if a value isn't finite.
  EnvironmentMap(Image radiance, double rotation, double scale);

  // The same radiance from everywhere.
  static EnvironmentMap Constant(const Rgb& radiance);

  Rgb Radiance(const Vec3& direction) const;

  // A direction, its density per solid angle and its radiance for two uniform numbers in [0, 1).
  // Texels are drawn by their luminance times their solid angle. Not to be called if IsBlack().
  Vec3 Sample(const std::array<double, 2>& u, double* pdf, Rgb* radiance) const;
  double Pdf(const Vec3& direction) const;

  bool IsBlack() const { return total_ == 0.0; }

 private:
  struct Texel {
    int x, y;
  };

  Texel TexelAt(const Vec3& direction) const;
  Rgb RadianceOf(const Texel& texel) const;
  double Density(const Texel& texel) const;

  Image radiance_;   // scaled
  double rotation_;  // radians
  double total_ = 0.0;
  std::vector<double> cos_theta_;  // of the rows' edges, height + 1
  std::vector<double> rows_;       // weight of the rows up to and including each
  std::vector<double> columns_;    // of each row's texels, likewise; height x width
};

}  // namespace pbnbrdf
