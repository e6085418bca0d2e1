// principled.h: the material of glTF 2.0, as artists' programs have it. model_parameter.h says what a formula is.
#pragma once

#include "models/sheen.h"
#include "pbnbrdf/brdf/ggx.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

// A dielectric, diffuse under GGX facets, that turns into a metal; cloth's sheen over it, and a colourless coat
// over all [1, appendix B], with its extensions [2] specular, anisotropy, sheen and clearcoat. The renderers of these
// materials agree about as well as their documents allow. Here all Fresnel terms are Schlick's at wi.h, also that of
// the coat, for which [2] has the angle of the viewer: the model is reciprocal. Its index of refraction is 1.5.
//
// [1] Khronos Group. glTF 2.0 Specification, 2.0.1, 2021.
// [2] Khronos Group. glTF extensions KHR_materials_specular, _anisotropy, _sheen, _clearcoat.
class PrincipledFormula : public NoLobe {
 public:
  static constexpr std::string_view kName = "principled",
                                    kPaper = "glTF 2.0, appendix B, and its KHR extensions";
  static constexpr std::array<ModelParameter, 10> kBase = {
      {{"base_color", 3, 0.5, 0.0, 1.0, "of the diffuse part, or of the metal", FitRole::kDiffuse},
       {"metallic", 1, 0.0, 0.0, 1.0, "0 a dielectric, 1 a metal"},
       {"roughness", 1, 0.5, 0.0, 1.0, "square root of the facets' width", FitRole::kWidth, 0.07,
        0.8},
       {"anisotropy", 1, 0.0, 0.0, 1.0, "how much wider the lobe is along x", FitRole::kShape, 0.0,
        0.0, false, WhenIsotropic::kZero},
       {"specular", 1, 1.0, 0.0, 1.0, "strength of what a dielectric's facets reflect"},
       {"specular_color", 3, 1.0, 0.0, 25.0,
        "0.04 times this is a dielectric's reflectance at normal incidence"},
       {"coat", 1, 0.0, 0.0, 1.0, "strength of a second, colourless lobe"},
       {"coat_roughness", 1, 0.1, 0.0, 1.0, "square root of the width of its facets"},
       {"sheen_color", 3, 0.0, 0.0, 1.0, "of cloth, at grazing angles"},
       {"sheen_roughness", 1, 0.5, 0.0, 1.0, "from velvet to dust"}}};

  template <typename T>
  static void AddBase(const ReflectionGeometry& g, const T* p, T* f) {
    const T *base = p, *specular_color = p + 7, *sheen_color = p + 12;
    const T &metallic = p[3], &specular = p[6];
    const T facets = Facets(g, /*roughness=*/p[4], /*anisotropy=*/p[5]);
    T fresnel[3];
    for (int c = 0; c < 3; ++c) {
      const T f0 = 0.04 * specular_color[c];
      fresnel[c] = SchlickFresnel(f0 < 1.0 ? f0 : T(1.0), g.cos_d);
    }
    const T transmitted = 1.0 - specular * LargestOf(fresnel);
    const T sheen = SheenLobe(g.Tan2H() * g.cos_h * g.cos_h, g.wi.z, g.wo.z, p[15]);
    const T under_sheen =
        1.0 - LargestOf(sheen_color) * SheenAlbedo(std::min(g.wi.z, g.wo.z), p[15]);
    const T coat_fresnel = p[10] * SchlickFresnel(0.04, g.cos_d);
    const T coat = Facets(g, /*roughness=*/p[11], T(0.0)) * coat_fresnel;
    for (int c = 0; c < 3; ++c) {
      const T dielectric =
          transmitted * base[c] * std::numbers::inv_pi + specular * fresnel[c] * facets;
      const T metal = SchlickFresnel(base[c], g.cos_d) * facets;
      const T solid = dielectric + (metal - dielectric) * metallic;
      f[c] += (solid * under_sheen + sheen_color[c] * sheen) * (1.0 - coat_fresnel) + coat;
    }
  }

 private:
  static constexpr double kMinWidth = 1e-3;

  template <typename T>
  static T LargestOf(const T* rgb) {
    const T larger = rgb[0] > rgb[1] ? rgb[0] : rgb[1];
    return larger > rgb[2] ? larger : rgb[2];
  }

  // D G / (4 cos_i cos_o)
  template <typename T>
  static T Facets(const ReflectionGeometry& g, const T& roughness, const T& anisotropy) {
    const T square = roughness * roughness;
    const T alpha_y = square < kMinWidth ? T(kMinWidth) : square;
    const T alpha_x = alpha_y + (1.0 - alpha_y) * anisotropy * anisotropy;
    const T masking = GgxMasking(g.wi, alpha_x, alpha_y) * GgxMasking(g.wo, alpha_x, alpha_y);
    return GgxDistribution(g, alpha_x, alpha_y) * masking * (0.25 / (g.wi.z * g.wo.z));
  }
};

}  // namespace pbnbrdf
