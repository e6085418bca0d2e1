// diffuse.h: diffuse reflectance: Lambert, and the rough surface of Oren and Nayar [1].
//
// [1] M. Oren, S. Nayar. Generalization of Lambert's Reflectance Model. SIGGRAPH 1994.
#pragma once

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

// The qualitative model of [1] over Lambert's value: V-cavities with normally distributed slopes,
// sigma the standard deviation of the facets' slope angle, radians.
template <typename T>
T OrenNayarFactor(const ReflectionGeometry& g, const T& sigma) {
  const T sigma2 = sigma * sigma;
  const T a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
  const T b = 0.45 * sigma2 / (sigma2 + 0.09);
  // sin(larger angle) tan(smaller angle) cos(difference of azimuths)
  const double sin_sin_cos_phi = std::max(0.0, g.wi.x * g.wo.x + g.wi.y * g.wo.y);
  return a + b * (sin_sin_cos_phi / std::max(g.wi.z, g.wo.z));
}

struct LambertFormula : LambertBase, NoLobe {
  static constexpr std::string_view kName = "lambert", kPaper = "Lambert 1760";
};

struct OrenNayarFormula : NoLobe {
  static constexpr std::string_view kName = "oren_nayar", kPaper = "Oren and Nayar 1994";
  static constexpr std::array<ModelParameter, 2> kBase = {
      {kDiffuseAlbedo,
       {"sigma", 1, 0.3, 0.0, 1.5, "standard deviation of the facets' slope angle, radians"}}};

  template <typename T>
  static void AddBase(const ReflectionGeometry& g, const T* base, T* f) {
    const T factor = OrenNayarFactor(g, base[3]) * std::numbers::inv_pi;
    for (int c = 0; c < 3; ++c) f[c] += base[c] * factor;
  }
};

// f = rho / pi; rho in [0, 1].
class LambertBrdf final : public PointwiseBrdf {
 public:
  explicit LambertBrdf(const Rgb& rho) : rho_(rho) {}
  std::string Description() const override;

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  Rgb rho_;
};

class OrenNayarBrdf final : public PointwiseBrdf {
 public:
  // sigma: radians, >= 0.
  OrenNayarBrdf(const Rgb& rho, double sigma) : rho_(rho), sigma_(sigma) {}
  std::string Description() const override;

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  Rgb rho_;
  double sigma_;
};

}  // namespace pbnbrdf
