#include "pbnbrdf/network/encoding.h"

#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

// 4 u (1 - u), u the fraction of 90 x: 0 at the rows of a MERL table, 1 midway.
double RowBend(double x) {
  const double row = 90.0 * x, u = row - std::floor(row);
  return 4.0 * u * (1.0 - u);
}

}  // namespace

std::array<double, kEncodedSize> Encode(Encoding encoding, const DirectionPair& pair) {
  const auto [h, d] = ToHalfDiff(pair);
  const double sin_h = std::hypot(h.x, h.y);
  const double s2 = d.x * d.x + d.y * d.y;
  const double doubled_x = d.x * d.x - d.y * d.y;  // s^2 cos 2 phi_d
  const double doubled_y = 2.0 * d.x * d.y;        // s^2 sin 2 phi_d
  switch (encoding) {
    case Encoding::kCartesian:
      return {sin_h, 0.0, h.z, d.x, d.y, d.z};
    case Encoding::kReciprocal: {
      const double per_s = s2 > 0.0 ? 1.0 / std::sqrt(s2) : 0.0;
      return {sin_h, 0.0, h.z, doubled_x * per_s, doubled_y * per_s, d.z};
    }
    case Encoding::kMultiscale:
    case Encoding::kMerl: {
      const double theta_h = std::atan2(sin_h, h.z);
      const double root = std::sqrt(theta_h * 2.0 / std::numbers::pi);
      return {encoding == Encoding::kMerl ? RowBend(root) : sin_h,
              root,
              std::log(theta_h + 1e-3) / 3.0,
              doubled_x,
              doubled_y,
              d.z};
    }
  }
  return {};
}

}  // namespace pbnbrdf
