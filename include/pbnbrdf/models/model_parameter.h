// model_parameter.h: what an analytic model says of each of its parameters.
//
// A formula is a type with two tables of them and what it adds to f, templated on the scalar, so
// that values and derivatives come from the same lines:
//
//   struct PhongFormula {
//     static constexpr std::string_view kName = "phong", kPaper = "...";
//     static constexpr std::array<ModelParameter, 1> kBase = {...};   // there once
//     static constexpr std::array<ModelParameter, 2> kLobe = {...};   // of each lobe; may be empty
//     template <typename T> static void AddBase(const ReflectionGeometry&, const T* base, T* f);
//     template <typename T> static void AddLobe(const ReflectionGeometry&, const T* lobe, T* f);
//   };
//
//   base, lobe  T[SizeOf(kBase)], T[SizeOf(kLobe)], the parameters one after the other.
//   f           T[3], linear RGB in 1/sr, added to.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>

#include "pbnbrdf/brdf/reflection_geometry.h"

namespace pbnbrdf {

// What a parameter is when the material is to be isotropic.
enum class WhenIsotropic {
  kFree,        // as it likes
  kAsPrevious,  // what the parameter before it is
  kZero,
};

// What a fit makes of a parameter when it begins.
enum class FitRole {
  kShape,    // its initial value
  kDiffuse,  // a colour: that of the darker half of the material
  kScale,    // a colour: what gives the lobe the brightness of the highlight
  kWidth,    // starts have it from `narrow` to `wide`, in equal ratios
};

struct ModelParameter {
  std::string_view name;
  int size;             // 3: linear R, G, B; 1: one number
  double initial;       // where it isn't given
  double lower, upper;  // what it must lie between, inclusive
  std::string_view meaning;
  FitRole role = FitRole::kShape;
  double narrow = 0.0, wide = 0.0;  // of kWidth, > 0
  bool logarithmic = false;         // fits search its logarithm; lower > 0
  WhenIsotropic when_isotropic = WhenIsotropic::kFree;
  std::string_view pair_name = "";  // kAsPrevious: sets this one and the one before
};

// The number of scalars in a table.
constexpr int SizeOf(std::span<const ModelParameter> table) {
  int size = 0;
  for (const ModelParameter& parameter : table) size += parameter.size;
  return size;
}

// Parameters that several formulas have.
inline constexpr ModelParameter kDiffuseAlbedo = {
    "rho_d", 3, 0.0, 0.0, 10.0, "diffuse albedo", FitRole::kDiffuse};
inline constexpr ModelParameter kSpecularScale = {
    "rho_s", 3, 1.0, 0.0, 1e4, "factor of the lobe", FitRole::kScale};
inline constexpr ModelParameter kNormalReflectance = {
    "f0", 3, 1.0, 0.0, 1.0, "Schlick's reflectance at normal incidence"};
inline constexpr ModelParameter kWidthX = {
    "alpha_x",       1,     0.2, 1e-4, 4.0, "width of the lobe along x, a slope",
    FitRole::kWidth, 0.004, 0.6, true};
inline constexpr ModelParameter kWidthY = {"alpha_y",
                                           1,
                                           0.2,
                                           1e-4,
                                           4.0,
                                           "width of the lobe along y, a slope",
                                           FitRole::kWidth,
                                           0.004,
                                           0.6,
                                           true,
                                           WhenIsotropic::kAsPrevious,
                                           "alpha"};
inline constexpr ModelParameter kExponent = {
    "n", 1, 100.0, 0.1, 1e7, "exponent of the cosine", FitRole::kWidth, 1e5, 4.0, true};

// f += value / pi for R, G, B.
template <typename T>
void AddLambert(const T* rho_d, T* f) {
  for (int c = 0; c < 3; ++c) f[c] += rho_d[c] * std::numbers::inv_pi;
}

// What formulas inherit that have Lambert's base (J. H. Lambert. Photometria. 1760), f = rho_d / pi, and
// those that have no lobe.
struct LambertBase {
  static constexpr std::array<ModelParameter, 1> kBase = {kDiffuseAlbedo};

  template <typename T>
  static void AddBase(const ReflectionGeometry&, const T* base, T* f) {
    AddLambert(base, f);
  }
};

struct NoLobe {
  static constexpr std::array<ModelParameter, 0> kLobe = {};

  template <typename T>
  static void AddLobe(const ReflectionGeometry&, const T*, T*) {}
};

}  // namespace pbnbrdf
