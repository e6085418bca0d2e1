// disney.h: the "principled" model of Disney [1]: diffuse with retroreflection, an approximate
// subsurface term, sheen, one lobe of GGX facets and a clear coat. Colours are linear.
//
// [1] B. Burley. Physically-Based Shading at Disney. SIGGRAPH 2012 course notes.
#pragma once

#include "pbnbrdf/models/microfacet.h"

namespace pbnbrdf {

class DisneyFormula {
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
       {.name = "anisotropic",
        .size = 1,
        .initial = 0.0,
        .lower = 0.0,
        .upper = 1.0,
        .meaning = "how much wider the lobe is along x",
        .when_isotropic = WhenIsotropic::kZero},
       {"sheen", 1, 0.0, 0.0, 1.0, "of cloth, at grazing angles"},
       {"sheen_tint", 1, 0.5, 0.0, 1.0, "from white to base_color"},
       {"clearcoat", 1, 0.0, 0.0, 1.0, "strength of a second, colourless lobe"},
       {"clearcoat_gloss", 1, 1.0, 0.0, 1.0, "from satin to gloss"}}};
  static constexpr std::array<ModelParameter, 0> kLobe = {};

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
  template <typename T>
  static void AddLobe(const ReflectionGeometry&, const T*, T*) {}

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
    const auto width = [](const T& alpha) { return alpha < kLeastWidth ? T(kLeastWidth) : alpha; };
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

  static constexpr double kLeastWidth = 1e-3;
};

}  // namespace pbnbrdf
