// microfacet.h: surfaces of mirror facets, D G F / (4 cos_i cos_o): GGX [1] and Beckmann's [2].
//
//   D        distribution of the facet normals; its integral with cos theta_h is 1
//   G        GGX: Smith's masking and shadowing (brdf/ggx.h); Beckmann: V-cavities [2]
//   F        Schlick's Fresnel reflectance (reflection_geometry.h)
//
// [1] B. Walter, S. Marschner, H. Li, K. Torrance. Microfacet Models for Refraction through Rough
//     Surfaces. EGSR 2007.
// [2] R. Cook, K. Torrance. A Reflectance Model for Computer Graphics. ACM TOG 1(1), 1982.
// [3] M. Ashikhmin, P. Shirley. An Anisotropic Phong BRDF Model. J. Graphics Tools 5(2), 2000.
#pragma once

#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/brdf/ggx.h"
#include "pbnbrdf/brdf/lobe_widths.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

// D of Beckmann, 1/sr.
template <typename T>
T BeckmannDistribution(const ReflectionGeometry& g, const T& alpha_x, const T& alpha_y) {
  using std::exp;
  const double cos2 = g.cos_h * g.cos_h;
  return exp(-StretchedTan2(g, alpha_x, alpha_y)) *
         (std::numbers::inv_pi / (cos2 * cos2 * alpha_x * alpha_y));
}

// What V-cavities leave unmasked and unshadowed, in [0, 1].
inline double VCavities(const ReflectionGeometry& g) {
  return std::min(1.0, 2.0 * g.cos_h * std::min(g.wi.z, g.wo.z) / g.cos_d);
}

// f += rho_s F(f0) value for R, G, B.
template <typename T>
void AddFresnelLobe(const ReflectionGeometry& g, const T* rho_s, const T* f0, const T& value,
                    T* f) {
  for (int c = 0; c < 3; ++c) f[c] += rho_s[c] * SchlickFresnel(f0[c], g.cos_d) * value;
}

struct GgxFormula : LambertBase {
  static constexpr std::string_view kName = "ggx", kPaper = "Walter et al. 2007, Smith's masking";
  static constexpr std::array<ModelParameter, 4> kLobe = {kSpecularScale, kNormalReflectance,
                                                          kWidthX, kWidthY};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    const T &alpha_x = lobe[6], &alpha_y = lobe[7];
    const T masking = GgxMasking(g.wi, alpha_x, alpha_y) * GgxMasking(g.wo, alpha_x, alpha_y);
    const T value = GgxDistribution(g, alpha_x, alpha_y) * masking * (0.25 / (g.wi.z * g.wo.z));
    AddFresnelLobe(g, lobe, lobe + 3, value, f);
  }
};

struct CookTorranceFormula : LambertBase {
  static constexpr std::string_view kName = "cook_torrance",
                                    kPaper = "Cook and Torrance 1982, Beckmann facets";
  static constexpr std::array<ModelParameter, 4> kLobe = {kSpecularScale, kNormalReflectance,
                                                          kWidthX, kWidthY};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    const T value =
        BeckmannDistribution(g, lobe[6], lobe[7]) * (0.25 * VCavities(g) / (g.wi.z * g.wo.z));
    AddFresnelLobe(g, lobe, lobe + 3, value, f);
  }
};

// GGX over the diffuse base of [3], which receives what the facets don't reflect.
class GgxBrdf final : public PointwiseBrdf {
 public:
  // alpha: widths of the distribution of facet normals. rho_d = 0 for metals.
  GgxBrdf(const Rgb& f0, LobeWidths alpha, const Rgb& rho_d = {})
      : f0_(f0), alpha_(alpha), rho_d_(rho_d) {}
  bool IsIsotropic() const override { return alpha_.AreEqual(); }
  std::string Description() const override;

 protected:
  Rgb Value(const DirectionPair& pair) const override;

 private:
  Rgb f0_;
  LobeWidths alpha_;
  Rgb rho_d_;
};

}  // namespace pbnbrdf
