#include "pbnbrdf/models/ward.h"

#include "models/show_rgb.h"

namespace pbnbrdf {

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
