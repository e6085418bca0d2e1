// phong.h: cosine lobes over a Lambertian base: Phong's [1] in its reciprocal, normalised form [2],
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
#pragma once

#include "pbnbrdf/brdf/reflection_geometry.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

struct PhongFormula {
  static constexpr std::string_view kName = "phong",
                                    kPaper =
                                        "Phong 1975, as Lafortune and Willems 1994 normalise it";
  static constexpr std::array<ModelParameter, 1> kBase = {kDiffuseAlbedo};
  static constexpr std::array<ModelParameter, 2> kLobe = {kSpecularScale, kExponent};

  template <typename T>
  static void AddBase(const ReflectionGeometry&, const T* base, T* f) {
    AddLambert(base, f);
  }
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

struct BlinnPhongFormula {
  static constexpr std::string_view kName = "blinn_phong", kPaper = "Blinn 1977, normalised";
  static constexpr std::array<ModelParameter, 1> kBase = {kDiffuseAlbedo};
  static constexpr std::array<ModelParameter, 2> kLobe = {kSpecularScale, kExponent};

  template <typename T>
  static void AddBase(const ReflectionGeometry&, const T* base, T* f) {
    AddLambert(base, f);
  }
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

}  // namespace pbnbrdf
