// rgl.h: measurements of the RGL material database, .bsdf files [1].
//
// Per node of the incident direction (phi_i, theta_i) a file holds a table of f cos_o 4 sigma / D over
// the unit square, which a map makes of outgoing directions: their half vector m, at
//
//   u = sqrt(2 theta_m / pi),  v = (phi_m + pi) / (2 pi),  phi_m from phi_i on if isotropic,
//
// is moved so that the density of normals that wi sees, "vndf", becomes uniform. D, "ndf", is the
// density of normals and sigma the area that they show to wi. Tables are bilinear, and blended
// linearly over theta_i and phi_i; beyond the last node of theta_i they stay as they are there.
//
// wi chooses the tables, so that f is reciprocal only as far as measurement and interpolation are.
//
// [1] J. Dupuy, W. Jakob. An Adaptive Parameterization for Efficient Material Acquisition and
//     Rendering. ACM TOG 37(6), 2018.
// [2] F. Fritsch, J. Butland. A Method for Constructing Local Monotone Piecewise Cubic Interpolants. SIAM
//     Journal on Scientific and Statistical Computing 5(2), 1984.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

class RglBrdf final : public Brdf {
 public:
  // RGB or spectral, the latter seen as cie.h says; isotropic if there are at most two phi_i, else
  // these must span the whole circle. Throws Error, naming the file and the field at fault.
  static RglBrdf Read(const std::string& path);

  // A channel below 0 (a colour beyond sRGB) is 0. 0 below the horizon.
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;

  // Whether both directions are within 85 degrees, of the best estimate 89.4, and the last node of
  // theta_i. Beyond it nothing was measured at wi; and at grazing wo f is what tables of f cos_o hold,
  // divided by next to nothing.
  bool IsKnown(const DirectionPair& pair) const override;

  // As stored: the same, but known as far as the best estimate is, and everywhere as well.
  //
  // The likeliest: the same tables, interpolated over theta_i between the format's own way, linear, and a monotone cubic [2]
  // of log(v + 0.03), v being a table's value: four tenths of one and six of the other. With both
  // orders averaged, as a reciprocal fit has them, that is nearer to measurements that were left out than the
  // cubic alone.
  std::unique_ptr<Brdf> BestEstimate(Estimate estimate) const override;

  // 1 at a measured theta_i, less in between: 1 / (1 + (7.7 d)^2), d the distance to the nearest one as a
  // fraction of the interval.
  double Certainty(const DirectionPair& pair) const override;
  std::optional<DirectionPair> NearestMeasured(const DirectionPair& pair) const override;

  // A node at 90 degrees isn't one: nothing can be measured there.
  std::vector<double> IncidentAngles() const override;
  std::unique_ptr<Brdf> WithoutIncidentAngle(std::size_t index) const override;

  bool HasOwnDirections() const override { return true; }
  bool IsIsotropic() const override;
  int NumChannels() const override { return wavelengths().size() == 1 ? 1 : 3; }
  std::string Description() const override;

  // nm, ascending; none of an RGB file.
  const std::vector<float>& wavelengths() const;

  // f at each wavelength, 1/sr, not clamped at 0; 0 below the horizon.
  std::vector<double> Spectrum(const DirectionPair& pair) const;

  // The density by solid angle of Sample's directions wo, given wi; 0 below the horizon. It follows
  // f cos_o, luminance only, closely. Both of unit length.
  double Pdf(const Vec3& wi, const Vec3& wo) const;

  // A direction wo for u0 and u1 uniform in [0, 1). Where it isn't above the horizon the sample
  // counts, with f = 0: Pdf integrates to less than 1 by as much.
  Vec3 Sample(const Vec3& wi, double u0, double u1) const;

 private:
  struct Tables;
  // Over theta_i. kStored is linear, too, but all of it counts as known and measured.
  enum class Interpolation { kLinear, kStored, kBest };

  RglBrdf(std::shared_ptr<const Tables> tables, Interpolation interpolation);

  std::shared_ptr<const Tables> tables_;
  Interpolation interpolation_;
};

}  // namespace pbnbrdf
