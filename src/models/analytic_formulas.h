// analytic_formulas.h: the formulas that no class of Brdf has (model_parameter.h says what a formula is), and
// the list of all, for whoever instantiates them.
#pragma once

#include <tuple>

#include "pbnbrdf/models/diffuse.h"
#include "pbnbrdf/models/microfacet.h"
#include "pbnbrdf/models/ward.h"

namespace pbnbrdf {

// Cosine lobes over a Lambertian base: Phong's [1] in its reciprocal, normalised form [2],
// and Blinn's [3].
//
// With m the mirror direction of wi,
//   phong        (n + 2) / (2 pi) max(0, m.wo)^n; its albedo is at most rho_s, and rho_s at normal
//                incidence
//   blinn_phong  (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) cos^n theta_h; its albedo at normal
//                incidence is rho_s
//
// [1] B. T. Phong. Illumination for Computer Generated Pictures. CACM 18(6), 1975.
// [2] E. Lafortune, Y. Willems. Using the Modified Phong Reflectance Model for Physically Based
//     Rendering. Report CW 197, K. U. Leuven, 1994.
// [3] J. Blinn. Models of Light Reflection for Computer Synthesized Pictures. SIGGRAPH 1977.
struct PhongFormula : LambertBase {
  static constexpr std::string_view kName = "phong",
                                    kPaper =
                                        "Phong 1975, as Lafortune and Willems 1994 normalise it";
  static constexpr std::array<ModelParameter, 2> kLobe = {kSpecularScale, kExponent};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    using std::exp;
    const Vec3 mirror = {-g.wi.x, -g.wi.y, g.wi.z}, away = mirror - g.wo;
    if (Dot(mirror, g.wo) <= 0.0) return;
    // 1 - |m - wo|^2 / 2 = m.wo, with the digits of narrow lobes.
    const double log_cos = std::log1p(-0.5 * Dot(away, away));
    const T& n = lobe[3];
    const T value = exp(n * log_cos) * (n + 2.0) * (0.5 * std::numbers::inv_pi);
    for (int c = 0; c < 3; ++c) f[c] += lobe[c] * value;
  }
};

struct BlinnPhongFormula : LambertBase {
  static constexpr std::string_view kName = "blinn_phong", kPaper = "Blinn 1977, normalised";
  static constexpr std::array<ModelParameter, 2> kLobe = {kSpecularScale, kExponent};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    using std::exp;
    const T& n = lobe[3];
    const double log_cos = -0.5 * std::log1p(g.Tan2H());
    const T scale = (n + 2.0) * (n + 4.0) / (exp(-0.5 * std::numbers::ln2 * n) + n);
    const T value = exp(n * log_cos) * scale * (0.125 * std::numbers::inv_pi);
    for (int c = 0; c < 3; ++c) f[c] += lobe[c] * value;
  }
};

// The generalised cosine lobe [1] over a Lambertian base.
//
//   rho_s (n + 2) / (2 pi) max(0, c_x wi.x wo.x + c_y wi.y wo.y + c_z wi.z wo.z)^n
//
// c = (-1, -1, 1) is the modified Phong lobe (above); c_z below |c_x| puts the peak off the
// mirror direction, c_x > 0 is retroreflective. [1] has the factor in c.
//
// [1] E. Lafortune, S.-C. Foo, K. Torrance, D. Greenberg. Non-Linear Approximation of Reflectance
//     Functions. SIGGRAPH 1997.
struct LafortuneFormula : LambertBase {
  static constexpr std::string_view kName = "lafortune", kPaper = "Lafortune et al. 1997";
  static constexpr std::array<ModelParameter, 5> kLobe = {
      {kSpecularScale,
       {"c_x", 1, -1.0, -2.0, 2.0, "factor of wi.x wo.x"},
       {"c_y", 1, -1.0, -2.0, 2.0, "factor of wi.y wo.y", FitRole::kShape, 0.0, 0.0, false,
        WhenIsotropic::kAsPrevious, "c_xy"},
       {"c_z", 1, 1.0, -2.0, 2.0, "factor of wi.z wo.z"},
       kExponent}};

  template <typename T>
  static void AddLobe(const ReflectionGeometry& g, const T* lobe, T* f) {
    using std::exp, std::log;
    const T cosine =
        lobe[3] * (g.wi.x * g.wo.x) + lobe[4] * (g.wi.y * g.wo.y) + lobe[5] * (g.wi.z * g.wo.z);
    if (!(cosine > 0.0)) return;
    const T& n = lobe[6];
    const T value = exp(n * log(cosine)) * (n + 2.0) * (0.5 * std::numbers::inv_pi);
    for (int c = 0; c < 3; ++c) f[c] += lobe[c] * value;
  }
};

// Facets whose distribution is the ABC curve [1], the form of scatter from polished surfaces
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

using AnalyticFormulas =
    std::tuple<LambertFormula, OrenNayarFormula, PhongFormula, BlinnPhongFormula, LafortuneFormula,
               WardFormula<WardVariant::kOriginal>, WardFormula<WardVariant::kDuer>,
               WardFormula<WardVariant::kBounded>, CookTorranceFormula, GgxFormula, AbcFormula,
               DisneyFormula>;

// f of the formula with `lobes` lobes, 1/sr; double parameters or Ceres' jets.
template <typename Formula, typename T>
std::array<T, 3> EvaluateFormula(const ReflectionGeometry& geometry, const T* parameters,
                                 int lobes) {
  std::array<T, 3> f = {T(0.0), T(0.0), T(0.0)};
  Formula::AddBase(geometry, parameters, f.data());
  for (int lobe = 0; lobe < lobes; ++lobe) {
    Formula::AddLobe(geometry, parameters + SizeOf(Formula::kBase) + lobe * SizeOf(Formula::kLobe),
                     f.data());
  }
  return f;
}

}  // namespace pbnbrdf
