// facets.h: the formulas of surfaces of mirror facets. model_parameter.h says what a formula is.
#pragma once

#include "pbnbrdf/brdf/ggx.h"
#include "pbnbrdf/brdf/lobe_widths.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

// Surfaces of mirror facets, D G F / (4 cos_i cos_o): GGX [1] and Beckmann's [2].
//
//   D        distribution of the facet normals; its integral with cos theta_h is 1
//   G        GGX: Smith's masking and shadowing (brdf/ggx.h); Beckmann: V-cavities [2]
//   F        Schlick's Fresnel reflectance (reflection_geometry.h)
//
// [1] B. Walter, S. Marschner, H. Li, K. Torrance. Microfacet Models for Refraction through Rough
//     Surfaces. EGSR 2007.
// [2] R. Cook, K. Torrance. A Reflectance Model for Computer Graphics. ACM TOG 1(1), 1982.

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

// Facets whose distribution is the ABC curve [1], the form of scatter from polished surfaces
// [2], over a Lambertian base.
//
//   rho_s F G / (cos_i cos_o (1 + b (1 - cos theta_h))^c)
//
// rho_s is the A of [1], F Schlick's Fresnel reflectance, G that of V-cavities (above).
//
// [1] J. Low, J. Kronander, A. Ynnerman, J. Unger. BRDF Models for Accurate and Efficient Rendering
//     of Glossy Surfaces. ACM TOG 31(1), 2012: the microfacet model.
// [2] E. Church, H. Jenkinson, J. Zavada. Relationship between Surface Scattering and
//     Microtopographic Features. Optical Engineering 18(2), 1979.
struct AbcFormula : LambertBase {
  static constexpr std::string_view kName = "abc", kPaper = "Low et al. 2012, microfacets";
  static constexpr std::array<ModelParameter, 4> kLobe = {
      {{"rho_s", 3, 1.0, 0.0, 1e9, "A: height of the lobe, 1/sr", FitRole::kScale},
       kNormalReflectance,
       {"b", 1, 100.0, 1e-3, 1e9, "B: inverse width of the lobe", FitRole::kWidth, 1e5, 4.0, true},
       {"c", 1, 2.0, 0.01, 100.0, "C: how fast its tail falls", FitRole::kShape, 0.0, 0.0, true}}};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    using std::exp, std::log1p;
    const T curve = exp(-lobe[7] * log1p(lobe[6] * g.VersineH()));
    AddFresnelLobe(g, lobe, lobe + 3, T(curve * (VCavities(g) / (g.wi.z * g.wo.z))), f);
  }
};

// The "principled" model of Disney [1]: diffuse with retroreflection, an approximate
// subsurface term, sheen, one lobe of GGX facets and a clear coat. Colours are linear.
//
// [1] B. Burley. Physically-Based Shading at Disney. SIGGRAPH 2012 course notes.
class DisneyFormula : public NoLobe {
 public:
  static constexpr std::string_view kName = "disney", kPaper = "Burley 2012";
  static constexpr std::array<ModelParameter, 11> kBase = {
      {{"base_color", 3, 0.5, 0.0, 1.0, "of the diffuse part, or of the metal", FitRole::kDiffuse},
       {"metallic", 1, 0.0, 0.0, 1.0, "0 a dielectric, 1 a metal"},
       {"subsurface", 1, 0.0, 0.0, 1.0, "from diffuse to subsurface scattering"},
       {"specular", 1, 0.5, 0.0, 1.0, "0.08 times this is the reflectance at normal incidence"},
       {"specular_tint", 1, 0.0, 0.0, 1.0, "from white to base_color"},
       {"roughness", 1, 0.5, 0.0, 1.0, "square root of the facets' width", FitRole::kWidth, 0.07,
        0.8},
       {"anisotropic", 1, 0.0, 0.0, 1.0, "how much wider the lobe is along x", FitRole::kShape, 0.0,
        0.0, false, WhenIsotropic::kZero},
       {"sheen", 1, 0.0, 0.0, 1.0, "of cloth, at grazing angles"},
       {"sheen_tint", 1, 0.5, 0.0, 1.0, "from white to base_color"},
       {"clearcoat", 1, 0.0, 0.0, 1.0, "strength of a second, colourless lobe"},
       {"clearcoat_gloss", 1, 1.0, 0.0, 1.0, "from satin to gloss"}}};

  template <typename T>
  static void AddBase(const ReflectionGeometry& g, const T* p, T* f) {
    const T &metallic = p[3], &specular = p[5], &specular_tint = p[6];
    const double schlick = Pow5(1.0 - g.cos_d);
    const T diffuse = Diffuse(g, /*roughness=*/p[7], /*subsurface=*/p[4]);
    const T facets = Facets(g, p[7], /*anisotropic=*/p[8]);
    const T coat = Coat(g, /*gloss=*/p[12]) * p[11];
    const T luminance = 0.3 * p[0] + 0.6 * p[1] + 0.1 * p[2];
    for (int c = 0; c < 3; ++c) {
      const T tint = luminance > 0.0 ? T(p[c] / luminance) : T(1.0);
      const T sheen = schlick * p[9] * Mix(T(1.0), tint, p[10]);
      const T f0 = Mix(T(0.08 * specular * Mix(T(1.0), tint, specular_tint)), p[c], metallic);
      f[c] +=
          (diffuse * p[c] + sheen) * (1.0 - metallic) + SchlickFresnel(f0, g.cos_d) * facets + coat;
    }
  }

 private:
  template <typename T>
  static T Mix(const T& a, const T& b, const T& t) {
    return a + (b - a) * t;
  }

  // Of base_color 1.
  template <typename T>
  static T Diffuse(const ReflectionGeometry& g, const T& roughness, const T& subsurface) {
    const double grazing_i = Pow5(1.0 - g.wi.z), grazing_o = Pow5(1.0 - g.wo.z);
    const T retro = roughness * (g.cos_d * g.cos_d);
    const T fd90 = 0.5 + 2.0 * retro;
    const T diffuse = (1.0 + (fd90 - 1.0) * grazing_i) * (1.0 + (fd90 - 1.0) * grazing_o);
    const T fss = (1.0 + (retro - 1.0) * grazing_i) * (1.0 + (retro - 1.0) * grazing_o);
    const T scattered = 1.25 * (fss * (1.0 / (g.wi.z + g.wo.z) - 0.5) + 0.5);
    return std::numbers::inv_pi * Mix(diffuse, scattered, subsurface);
  }

  // D G / (4 cos_i cos_o); the masking is that of a rougher surface, as [1] found to look better.
  template <typename T>
  static T Facets(const ReflectionGeometry& g, const T& roughness, const T& anisotropic) {
    using std::sqrt;
    const T aspect = sqrt(1.0 - 0.9 * anisotropic);
    const auto width = [](const T& alpha) { return alpha < kMinWidth ? T(kMinWidth) : alpha; };
    const T alpha_x = width(roughness * roughness / aspect);
    const T alpha_y = width(roughness * roughness * aspect);
    const T masking_root = 0.5 + 0.5 * roughness, masking_alpha = masking_root * masking_root;
    const T mask_x = masking_alpha / aspect, mask_y = masking_alpha * aspect;
    return GgxDistribution(g, alpha_x, alpha_y) * GgxMasking(g.wi, mask_x, mask_y) *
           GgxMasking(g.wo, mask_x, mask_y) * (0.25 / (g.wi.z * g.wo.z));
  }

  // Generalised Trowbridge-Reitz facets with the exponent 1, f0 = 0.04, masked as of width 0.25; a
  // quarter of it, as [1] has it.
  template <typename T>
  static T Coat(const ReflectionGeometry& g, const T& gloss) {
    using std::log;
    const T alpha = Mix(T(0.1), T(0.001), gloss), alpha2 = alpha * alpha;
    const double cos2 = g.cos_h * g.cos_h, sin2 = g.Tan2H() * cos2;
    const T distribution =
        (alpha2 - 1.0) * std::numbers::inv_pi / (log(alpha2) * (sin2 + alpha2 * cos2));
    const double masking = GgxMasking(g.wi, 0.25, 0.25) * GgxMasking(g.wo, 0.25, 0.25);
    return distribution *
           (0.25 * SchlickFresnel(0.04, g.cos_d) * masking * 0.25 / (g.wi.z * g.wo.z));
  }

  static constexpr double kMinWidth = 1e-3;
};

}  // namespace pbnbrdf
