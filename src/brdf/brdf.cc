#include "pbnbrdf/brdf/brdf.h"

#include <algorithm>
#include <cmath>

namespace pbnbrdf {
namespace {

constexpr double kMinProduct = -0.999;  // of f cos theta_i: log1p is defined beyond -1

}  // namespace

bool IsUsable(const BrdfSample& sample) {
  const double cos_i = CosI(sample.pair);
  return std::all_of(sample.value.begin(), sample.value.end(),
                     [&](double v) { return v * cos_i > kMinProduct && std::isfinite(v); });
}

void Brdf::Evaluate(std::span<const DirectionPair> pairs, std::span<Rgb> values) const {
  EvaluateUnclipped(pairs, values);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (!pairs[n].AboveHorizon()) values[n] = {};
    for (double& value : values[n]) value = value < 0.0 ? 0.0 : value;  // NaN stays
  }
}

void PointwiseBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                      std::span<Rgb> values) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    values[n] = pairs[n].AboveHorizon() ? Value(pairs[n]) : Rgb{};
    for (double& value : values[n]) {
      value = value < kLargestValue ? value : kLargestValue;  // NaN too
    }
  }
}

}  // namespace pbnbrdf
