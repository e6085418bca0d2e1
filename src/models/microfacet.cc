#include "pbnbrdf/models/microfacet.h"

#include "models/show_rgb.h"

namespace pbnbrdf {

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

}  // namespace pbnbrdf
