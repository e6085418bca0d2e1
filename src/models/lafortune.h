// lafortune.h: the generalised cosine lobe [1] over a Lambertian base.
//
//   rho_s (n + 2) / (2 pi) max(0, c_x wi.x wo.x + c_y wi.y wo.y + c_z wi.z wo.z)^n
//
// c = (-1, -1, 1) is the modified Phong lobe (phong.h); c_z below |c_x| puts the peak off the
// mirror direction, c_x > 0 is retroreflective. [1] has the factor in c.
//
// [1] E. Lafortune, S.-C. Foo, K. Torrance, D. Greenberg. Non-Linear Approximation of Reflectance
//     Functions. SIGGRAPH 1997.
#pragma once

#include "pbnbrdf/brdf/reflection_geometry.h"
#include "pbnbrdf/models/model_parameter.h"

namespace pbnbrdf {

struct LafortuneFormula {
  static constexpr std::string_view kName = "lafortune", kPaper = "Lafortune et al. 1997";
  static constexpr std::array<ModelParameter, 1> kBase = {kDiffuseAlbedo};
  static constexpr std::array<ModelParameter, 5> kLobe = {
      {kSpecularScale,
       {"c_x", 1, -1.0, -2.0, 2.0, "factor of wi.x wo.x"},
       {.name = "c_y",
        .size = 1,
        .initial = -1.0,
        .lower = -2.0,
        .upper = 2.0,
        .meaning = "factor of wi.y wo.y",
        .when_isotropic = WhenIsotropic::kAsPrevious,
        .pair_name = "c_xy"},
       {"c_z", 1, 1.0, -2.0, 2.0, "factor of wi.z wo.z"},
       kExponent}};

  template <typename T>
  static void AddBase(const ReflectionGeometry&, const T* base, T* f) {
    AddLambert(base, f);
  }
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

}  // namespace pbnbrdf
