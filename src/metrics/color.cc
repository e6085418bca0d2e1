#include "pbnbrdf/metrics/color.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/pi.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = kPi / 180.0;

// From the primaries (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) and the white (0.3127, 0.3290).
constexpr double kToXyz[3][3] = {{0.4123907992659595, 0.357584339383878, 0.1804807884018343},
                                 {0.21263900587151036, 0.715168678767756, 0.07219231536073371},
                                 {0.01933081871559185, 0.11919477979462599, 0.9505321522496607}};

// The inverse.
constexpr double kFromXyz[3][3] = {{3.2409699419045226, -1.537383177570094, -0.4986107602930034},
                                   {-0.9692436362808796, 1.8759675015077202, 0.04155505740717559},
                                   {0.05563007969699366, -0.20397695888897652, 1.0569715142428786}};

// CIELAB's compressive function: a cube root that continues as a line towards 0.
double Compress(double t) {
  constexpr double kKnee = 6.0 / 29.0;
  return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
}

// sqrt(c^7 / (c^7 + 25^7)), which neither overflows nor divides 0 by 0.
double Saturation(double c) { return 1.0 / std::sqrt(1.0 + std::pow(25.0 / c, 7.0)); }

// [0, 2 pi); 0 at the origin, where it is undefined.
double Hue(double a, double b) {
  const double hue = a == 0.0 && b == 0.0 ? 0.0 : std::atan2(b, a);
  return hue < 0.0 ? hue + 2.0 * kPi : hue;
}

// What [3] makes of two hues: their signed difference in [-pi, pi] and their mean in [0, 2 pi).
struct HuePair {
  double difference, mean;
};

// Where one of the colours is grey the mean is the other's hue, the sum, as a grey's is 0.
HuePair CompareHues(double x, double y, bool has_grey) {
  if (has_grey) return {0.0, x + y};
  // Opposite hues count as no further apart than pi, whatever the rounding of their angles.
  constexpr double kHalfTurn = kPi * (1.0 + 1e-14);
  const double difference = y - x, mean = 0.5 * (x + y);
  if (std::abs(difference) <= kHalfTurn) return {difference, mean};
  return {difference > 0.0 ? difference - 2.0 * kPi : difference + 2.0 * kPi,
          mean < kPi ? mean + kPi : mean - kPi};
}

}  // namespace

std::array<double, 3> ToXyz(const Rgb& linear) {
  std::array<double, 3> xyz = {};
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) xyz[i] += kToXyz[i][c] * linear[c];
  }
  return xyz;
}

Rgb FromXyz(const std::array<double, 3>& xyz) {
  Rgb linear = {};
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 3; ++i) linear[c] += kFromXyz[c][i] * xyz[i];
  }
  return linear;
}

Lab ToLab(const Rgb& linear) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  const std::array<double, 3> white = ToXyz({1.0, 1.0, 1.0}), xyz = ToXyz(linear);
  Rgb f;
  for (int i = 0; i < 3; ++i) f[i] = Compress(std::min(xyz[i] / white[i], kLargest));
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

// The equations are numbered as in [3].
double DeltaE2000(const Lab& x, const Lab& y) {
  // Eqs. 2 to 7: a is stretched where there is little chroma.
  const double g = 0.5 * (1.0 - Saturation(0.5 * (std::hypot(x.a, x.b) + std::hypot(y.a, y.b))));
  const double a_x = (1.0 + g) * x.a, a_y = (1.0 + g) * y.a;
  const double c_x = std::hypot(a_x, x.b), c_y = std::hypot(a_y, y.b);
  const HuePair hue = CompareHues(Hue(a_x, x.b), Hue(a_y, y.b), c_x == 0.0 || c_y == 0.0);

  // Eqs. 8 to 11.
  const double d_l = y.l - x.l, d_c = c_y - c_x;
  const double d_h = 2.0 * std::sqrt(c_x) * std::sqrt(c_y) * std::sin(0.5 * hue.difference);

  // Eqs. 12 to 21.
  const double c = 0.5 * (c_x + c_y), h = hue.mean;
  const double t = 1.0 - 0.17 * std::cos(h - 30.0 * kDegree) + 0.24 * std::cos(2.0 * h) +
                   0.32 * std::cos(3.0 * h + 6.0 * kDegree) -
                   0.20 * std::cos(4.0 * h - 63.0 * kDegree);
  const double from_blue = (h / kDegree - 275.0) / 25.0;
  const double turn = 30.0 * kDegree * std::exp(-from_blue * from_blue);
  const double off_grey = 0.5 * (x.l + y.l) - 50.0;
  const double s_l = 1.0 + 0.015 * off_grey * off_grey / std::sqrt(20.0 + off_grey * off_grey);
  const double l = d_l / s_l;
  const double chroma = d_c / (1.0 + 0.045 * c);
  const double tint = d_h / (1.0 + 0.015 * c * t);
  const double rotation = -std::sin(2.0 * turn) * 2.0 * Saturation(c);

  // Eq. 22. |rotation| < 2, so that the sum is negative by rounding at most.
  const double square = l * l + chroma * chroma + tint * tint + rotation * chroma * tint;
  return square < 0.0 ? 0.0 : std::sqrt(square);
}

double HueChromaDifference(const Lab& x, const Lab& y) { return std::hypot(y.a - x.a, y.b - x.b); }

}  // namespace pbnbrdf
