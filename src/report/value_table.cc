#include "report/value_table.h"

#include <half.h>

#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr double kHalfPi = 0.5 * std::numbers::pi;

double Centre(int index, int count) { return (index + 0.5) / count; }

// Where the material isn't known, or a direction isn't above the horizon, the values before.
class LastKnown {
 public:
  explicit LastKnown(const Brdf& material) : material_(material) {}

  Rgb At(const DirectionPair& pair) {
    if (pair.AboveHorizon() && material_.IsKnown(pair)) {
      const DirectionPair both[] = {pair, Swapped(pair)};
      Rgb values[2];
      material_.Evaluate(both, values);
      for (std::size_t c = 0; c < 3; ++c) last_[c] = 0.5 * (values[0][c] + values[1][c]);
    }
    return last_;
  }

 private:
  const Brdf& material_;
  Rgb last_ = {};
};

}  // namespace

std::vector<std::uint16_t> ValueTable(const Brdf& material, const ValueTableSize& size) {
  std::vector<std::uint16_t> table;
  for (int p = 0; p < size.phi_d; ++p) {
    for (int d = 0; d < size.theta_d; ++d) {
      LastKnown values(material);
      for (int h = 0; h < size.theta_h; ++h) {
        const double u = Centre(h, size.theta_h);
        const Rgb value =
            values.At(FromAngles({.theta_h = kHalfPi * u * u,
                                  .theta_d = kHalfPi * Centre(d, size.theta_d),
                                  .phi_d = std::numbers::pi * Centre(p, size.phi_d)}));
        for (const double v : value) {
          table.push_back(half(static_cast<float>(std::log1p(v / kValueTableUnit))).bits());
        }
      }
    }
  }
  return table;
}

}  // namespace pbnbrdf
