// environment_map.h: light from infinitely far away, as an image of all directions.
//
// A latitude-longitude image: rows are equal steps of theta from +y at the top to -y at the bottom,
// columns are equal steps of phi from 0 at the left edge, and the direction is
// (sin theta sin phi, cos theta, -sin theta cos phi), as in Mitsuba. Radiance is constant within a
// texel, and so is the density, per solid angle, of sampled directions.
#pragma once

#include <array>
#include <vector>

#include "pbnbrdf/brdf/direction.h"
#include "pbnbrdf/image/image.h"

namespace pbnbrdf {

class EnvironmentMap {
 public:
  // radiance: W / (m^2 sr), at least one texel. Negative values, which resampling may leave, count as
  // 0. rotation: degrees about +y, right-handed. scale: a factor, finite and >= 0. Throws Error, with
  // the texel, if a value is not finite.
  EnvironmentMap(Image radiance, double rotation, double scale);

  // The same radiance from everywhere.
  static EnvironmentMap Constant(const Rgb& radiance);

  Rgb Radiance(const Vec3& direction) const;

  // A direction for two uniform numbers in [0, 1), its density per solid angle, and its radiance.
  // Texels are drawn in proportion to luminance times solid angle. The map must not be black.
  Vec3 Sample(const std::array<double, 2>& u, double* pdf, Rgb* radiance) const;
  double Pdf(const Vec3& direction) const;

  bool IsBlack() const { return total_ == 0.0; }

 private:
  struct Texel {
    int x, y;
  };

  Texel TexelAt(const Vec3& direction) const;
  Rgb RadianceOf(const Texel& texel) const;
  double PdfOf(const Texel& texel) const;

  Image radiance_;   // scaled
  double rotation_;  // radians
  double total_ = 0.0;
  std::vector<double> cos_theta_;  // of the rows' edges, height + 1
  // Running sums of the texels' weights.
  std::vector<double> rows_;     // over rows
  std::vector<double> columns_;  // within each row, height x width
};

}  // namespace pbnbrdf
