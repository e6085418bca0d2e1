#include "pbnbrdf/models/diffuse.h"

#include "models/show_rgb.h"

namespace pbnbrdf {

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

}  // namespace pbnbrdf
