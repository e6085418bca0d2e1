#include "sources/angles.h"

#include <cmath>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kSlack = 1e-3;  // radians: rounding
constexpr std::array<const char*, 4> kNames = {"theta_i", "phi_i", "theta_o", "phi_o"};

}  // namespace

DirectionPair PairFromAngles(const std::string& place, const std::array<double, 4>& angles,
                             std::string_view hint) {
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const double most = (k % 2 == 0 ? 1.0 : 2.0) * std::numbers::pi;
    if (!(std::abs(angles[k]) <= most + kSlack)) {
      Fail(place, ": ", kNames[k], " is ", angles[k], " radians; must be ", -most, " to ", most,
           hint);
    }
  }
  return {FromSpherical(angles[0], angles[1]), FromSpherical(angles[2], angles[3])};
}

}  // namespace pbnbrdf
