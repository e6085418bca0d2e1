#include "pbnbrdf/network/encoding.h"

#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

using Inputs = std::array<double, kEncodedSize>;

// 4 u (1 - u), u the fraction of 90 x: 0 at the rows of a MERL table, 1 midway.
double RowBend(double x) {
  const double row = 90.0 * x, u = row - std::floor(row);
  return 4.0 * u * (1.0 - u);
}

// The tangential part of a vector of length 1, squared as a complex number:
// sin^2 theta (cos 2 phi, sin 2 phi). The same bits for (x, y) and (-x, -y).
struct DoubledPhi {
  DoubledPhi(double dx, double dy) : x(dx * dx - dy * dy), y(2.0 * dx * dy) {}
  double x, y;
};

Inputs EncodeAnisotropic(const HalfDiff& v, double sin_h, double root, double log) {
  const double cos_phi = sin_h > 0.0 ? v.h.x / sin_h : 1.0;
  const double sin_phi = sin_h > 0.0 ? v.h.y / sin_h : 0.0;
  const DoubledPhi doubled(v.d.x * cos_phi - v.d.y * sin_phi, v.d.x * sin_phi + v.d.y * cos_phi);
  const double r = root * std::sqrt(root);
  return {r * cos_phi, r * sin_phi, log, doubled.x, doubled.y, v.d.z};
}

// The encodings that take theta_h itself.
Inputs EncodeTheta(Encoding encoding, const HalfDiff& v) {
  const double sin_h = std::hypot(v.h.x, v.h.y);
  const double theta_h = std::atan2(sin_h, v.h.z);
  const double root = std::sqrt(theta_h * 2.0 / std::numbers::pi);
  const double log = std::log(theta_h + 1e-3) / 3.0;
  if (encoding == Encoding::kAnisotropic) return EncodeAnisotropic(v, sin_h, root, log);
  const DoubledPhi doubled(v.d.x, v.d.y);
  const double first = encoding == Encoding::kMultiscale ? sin_h : RowBend(root);
  const double fifth = encoding == Encoding::kBilateral ? sin_h : doubled.y;
  return {first, root, log, doubled.x, fifth, v.d.z};
}

}  // namespace

Encoding EncodingFor(const Brdf& material) {
  return material.IsIsotropic() ? Encoding::kMerl : Encoding::kAnisotropic;
}

Inputs Encode(Encoding encoding, const DirectionPair& pair) {
  const HalfDiff v = ToHalfDiff(pair);
  const auto& [h, d] = v;
  switch (encoding) {
    case Encoding::kCartesian:
      return {std::hypot(h.x, h.y), 0.0, h.z, d.x, d.y, d.z};
    case Encoding::kReciprocal: {
      const double s2 = d.x * d.x + d.y * d.y;
      const double per_s = s2 > 0.0 ? 1.0 / std::sqrt(s2) : 0.0;
      const DoubledPhi doubled(d.x, d.y);
      return {std::hypot(h.x, h.y), 0.0, h.z, doubled.x * per_s, doubled.y * per_s, d.z};
    }
    case Encoding::kMultiscale:
    case Encoding::kMerl:
    case Encoding::kBilateral:
    case Encoding::kAnisotropic:
      return EncodeTheta(encoding, v);
  }
  return {};
}

}  // namespace pbnbrdf
