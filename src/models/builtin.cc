#include "pbnbrdf/models/builtin.h"

#include <numbers>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

using Pointer = std::unique_ptr<Brdf>;

constexpr std::string_view kLabsphere =
    "Labsphere Spectralon SRS-99: diffuse reflectance 0.99 over the visible range";
constexpr std::string_view kWard = "Ward 1992, table 1 (measured; isotropic rows)";
constexpr std::string_view kWardElliptic = "Ward 1992, table 1 (measured; anisotropic rows)";
constexpr std::string_view kOrenNayar = "Oren and Nayar 1994: their fits to measured samples";
constexpr std::string_view kMetals =
    "f0: Akenine-Moeller et al., Real-Time Rendering, 4th edition 2018, table 9.2; width chosen";
constexpr std::string_view kPatches =
    "base: Macbeth ColorChecker patch, sRGB data of Pascale 2006, made linear; f0 of n = 1.5; "
    "width chosen";

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Rgb kGlass = {0.04, 0.04, 0.04};  // ((1.5 - 1) / (1.5 + 1))^2

Rgb Grey(double value) { return {value, value, value}; }

Pointer Ward(double rho_d, double rho_s, double alpha) {
  return std::make_unique<WardBrdf>(Grey(rho_d), Grey(rho_s), alpha);
}
Pointer Ward(double rho_d, double rho_s, double alpha_x, double alpha_y) {
  return std::make_unique<WardBrdf>(Grey(rho_d), Grey(rho_s), LobeWidths(alpha_x, alpha_y));
}
Pointer OrenNayar(double rho, double sigma_degrees) {
  return std::make_unique<OrenNayarBrdf>(Grey(rho), sigma_degrees * kDegree);
}
Pointer Metal(const Rgb& f0, LobeWidths alpha) { return std::make_unique<GgxBrdf>(f0, alpha); }
Pointer Plastic(const Rgb& rho_d, double alpha) {
  return std::make_unique<GgxBrdf>(kGlass, alpha, rho_d);
}

constexpr BuiltinMaterial kMaterials[] = {
    {"spectralon", kLabsphere, [] { return Pointer(new LambertBrdf(Grey(0.99))); }},
    {"wall-plaster", kOrenNayar, [] { return OrenNayar(0.90, 30.0); }},
    {"white-sand", kOrenNayar, [] { return OrenNayar(0.80, 35.0); }},
    {"white-ceramic-tile", kWard, [] { return Ward(0.70, 0.050, 0.071); }},
    {"glossy-grey-paper", kWard, [] { return Ward(0.29, 0.083, 0.082); }},
    {"ivory-computer-plastic", kWard, [] { return Ward(0.45, 0.043, 0.13); }},
    {"plastic-laminate", kWard, [] { return Ward(0.67, 0.070, 0.092); }},
    {"blue-plastic", kPatches,
     [] {
       return Plastic({0.040, 0.047, 0.305}, 0.05);
     }},
    {"red-satin-plastic", kPatches,
     [] {
       return Plastic({0.429, 0.031, 0.041}, 0.25);
     }},
    {"rough-iron", kMetals,
     [] {
       return Metal({0.562, 0.565, 0.578}, 0.4);
     }},
    {"satin-gold", kMetals,
     [] {
       return Metal({1.000, 0.782, 0.344}, 0.2);
     }},
    {"brushed-copper", kMetals,
     [] {
       return Metal({0.955, 0.638, 0.538}, 0.1);
     }},
    {"polished-chromium", kMetals,
     [] {
       return Metal({0.549, 0.556, 0.554}, 0.01);
     }},
    {"silver-mirror", kMetals,
     [] {
       return Metal({0.972, 0.960, 0.915}, 0.001);
     }},
    // Anisotropic.
    {"rolled-brass", kWardElliptic, [] { return Ward(0.10, 0.33, 0.050, 0.16); }},
    {"rolled-aluminium", kWardElliptic, [] { return Ward(0.10, 0.21, 0.04, 0.09); }},
    {"lightly-brushed-aluminium", kWardElliptic, [] { return Ward(0.15, 0.19, 0.088, 0.13); }},
    {"varnished-plywood", kWardElliptic, [] { return Ward(0.33, 0.025, 0.04, 0.11); }},
    {"enamel-finished-metal", kWardElliptic, [] { return Ward(0.25, 0.047, 0.080, 0.096); }},
    {"painted-cardboard-box", kWardElliptic, [] { return Ward(0.19, 0.043, 0.076, 0.085); }},
    {"brushed-aluminium", kMetals,
     [] {
       return Metal({0.913, 0.922, 0.924}, {0.08, 0.35});
     }},
};

}  // namespace

std::span<const BuiltinMaterial> BuiltinMaterials() { return kMaterials; }

std::unique_ptr<Brdf> MakeBuiltin(std::string_view name) {
  return FindNamed(kMaterials, "builtin:", name).make();
}

}  // namespace pbnbrdf
