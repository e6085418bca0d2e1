// The classes of Brdf that have a formula and parameters of their own.
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/models/diffuse.h"
#include "pbnbrdf/models/microfacet.h"
#include "pbnbrdf/models/ward.h"

namespace pbnbrdf {
namespace {

std::string Show(const Rgb& rgb) { return StrCat("(", rgb[0], ", ", rgb[1], ", ", rgb[2], ")"); }

}  // namespace

std::string LambertBrdf::Description() const { return StrCat("Lambert, rho ", Show(rho_)); }

Rgb LambertBrdf::Value(const DirectionPair&) const {
  Rgb value = {};
  AddLambert(rho_.data(), value.data());
  return value;
}

std::string OrenNayarBrdf::Description() const {
  return StrCat("Oren-Nayar, rho ", Show(rho_), ", sigma ", sigma_);
}

Rgb OrenNayarBrdf::Value(const DirectionPair& pair) const {
  const double parameters[] = {rho_[0], rho_[1], rho_[2], sigma_};
  Rgb value = {};
  OrenNayarFormula::AddBase(ReflectionGeometry(pair), parameters, value.data());
  return value;
}

std::string GgxBrdf::Description() const {
  return StrCat("GGX, f0 ", Show(f0_), ", ", alpha_.Description(), ", rho_d ", Show(rho_d_));
}

Rgb GgxBrdf::Value(const DirectionPair& pair) const {
  const double lobe[] = {1.0, 1.0, 1.0, f0_[0], f0_[1], f0_[2], alpha_.x, alpha_.y};
  Rgb value = {};
  GgxFormula::AddLobe(ReflectionGeometry(pair), lobe, value.data());
  const double diffuse = 28.0 / 23.0 * std::numbers::inv_pi * (1.0 - Pow5(1.0 - 0.5 * pair.wi.z)) *
                         (1.0 - Pow5(1.0 - 0.5 * pair.wo.z));
  for (int c = 0; c < 3; ++c) value[c] += rho_d_[c] * (1.0 - f0_[c]) * diffuse;
  return value;
}

std::string WardBrdf::Description() const {
  return StrCat("Ward, rho_d ", Show(rho_d_), ", rho_s ", Show(rho_s_), ", ", alpha_.Description());
}

Rgb WardBrdf::Value(const DirectionPair& pair) const {
  const double lobe = WardLobe(WardVariant::kBounded, ReflectionGeometry(pair), alpha_.x, alpha_.y);
  Rgb value = {};
  AddLambert(rho_d_.data(), value.data());
  for (int c = 0; c < 3; ++c) value[c] += rho_s_[c] * lobe;
  return value;
}

}  // namespace pbnbrdf
