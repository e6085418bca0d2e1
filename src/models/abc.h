// abc.h: facets whose distribution is the ABC curve [1], the form of scatter from polished surfaces
// [2], over a Lambertian base.
//
//   rho_s F G / (cos_i cos_o (1 + b (1 - cos theta_h))^c)
//
// rho_s is the A of [1], F Schlick's Fresnel reflectance, G that of V-cavities (microfacet.h).
//
// [1] J. Low, J. Kronander, A. Ynnerman, J. Unger. BRDF Models for Accurate and Efficient Rendering
//     of Glossy Surfaces. ACM TOG 31(1), 2012: the microfacet model.
// [2] E. Church, H. Jenkinson, J. Zavada. Relationship between Surface Scattering and
//     Microtopographic Features. Optical Engineering 18(2), 1979.
#pragma once

#include "pbnbrdf/models/microfacet.h"

namespace pbnbrdf {

struct AbcFormula {
  static constexpr std::string_view kName = "abc", kPaper = "Low et al. 2012, microfacets";
  static constexpr std::array<ModelParameter, 1> kBase = {kDiffuseAlbedo};
  static constexpr std::array<ModelParameter, 4> kLobe = {
      {{"rho_s", 3, 1.0, 0.0, 1e9, "A: height of the lobe, 1/sr", FitRole::kScale},
       kNormalReflectance,
       {"b", 1, 100.0, 1e-3, 1e9, "B: inverse width of the lobe", FitRole::kWidth, 1e5, 4.0, true},
       {"c", 1, 2.0, 0.01, 100.0, "C: how fast its tail falls", FitRole::kShape, 0.0, 0.0, true}}};

  template <typename T>
  static void AddBase(const ReflectionGeometry&, const T* base, T* f) {
    AddLambert(base, f);
  }
  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    using std::exp, std::log1p;
    const T curve = exp(-lobe[7] * log1p(lobe[6] * g.VersineH()));
    AddFresnelLobe(g, lobe, lobe + 3, T(curve * (VCavities(g) / (g.wi.z * g.wo.z))), f);
  }
};

}  // namespace pbnbrdf
