// enclosure.h: what can be said of a number and its derivatives all over a box.
//
// An Enclosure<D> is a continuous function of D variables on a box: its value at the box's centre, an interval that
// holds all its values there, and for each variable an interval that holds its derivative wherever there is one. By
// the mean value theorem (for functions with kinks: Lebourg's) f(x) - f(centre) lies in the sum over d of
// slope_d (x_d - centre_d). It has the operations of brdf/operations.h. Rounding isn't included: intervals are as
// wide as double precision makes them.
//
// [1] R. E. Moore, R. B. Kearfott, M. J. Cloud. Introduction to Interval Analysis. SIAM, 2009.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/pi.h"

namespace pbnbrdf {

struct Interval {
  double low = 0.0, high = 0.0;
};

inline Interval Hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

// Infinite ends are allowed; infinity - infinity is all numbers, 0 times infinity 0.
inline Interval operator+(const Interval& a, const Interval& b) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double low = a.low + b.low, high = a.high + b.high;
  return {std::isnan(low) ? -kInfinity : low, std::isnan(high) ? kInfinity : high};
}

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }

inline Interval operator*(const Interval& a, const Interval& b) {
  double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  if (std::isnan(p + q + r + s)) {
    for (double* product : {&p, &q, &r, &s}) {
      if (std::isnan(*product)) *product = 0.0;
    }
  }
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}

// 1 / a. All numbers where a has both signs.
inline Interval Inverse(const Interval& a) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.low < 0.0 && a.high > 0.0) return {-kInfinity, kInfinity};
  return {a.high == 0.0 ? -kInfinity : 1.0 / a.high, a.low == 0.0 ? kInfinity : 1.0 / a.low};
}

template <int D>
struct Enclosure {
  double center = 0.0;
  Interval range;
  std::array<Interval, D> slopes = {};

  Enclosure() = default;
  Enclosure(double constant) : center(constant), range{constant, constant} {}  // NOLINT

  // The variable d itself, from center - radius to center + radius.
  static Enclosure Variable(int d, double center, double radius) {
    Enclosure x(center);
    x.range = {center - radius, center + radius};
    x.slopes[d] = {1.0, 1.0};
    return x;
  }

  // A function of this one: its value at the centre, its values, and its derivative's.
  Enclosure Then(double value, const Interval& values, const Interval& derivative) const {
    Enclosure y(value);
    y.range = values;
    for (int d = 0; d < D; ++d) y.slopes[d] = derivative * slopes[d];
    return y;
  }
};

template <int D>
Enclosure<D> operator+(Enclosure<D> a, const Enclosure<D>& b) {
  a.center += b.center;
  a.range = a.range + b.range;
  for (int d = 0; d < D; ++d) a.slopes[d] = a.slopes[d] + b.slopes[d];
  return a;
}

template <int D>
Enclosure<D> operator-(const Enclosure<D>& a) {
  return a.Then(-a.center, -a.range, {-1.0, -1.0});
}

template <int D>
Enclosure<D> operator-(const Enclosure<D>& a, const Enclosure<D>& b) {
  return a + -b;
}

template <int D>
Enclosure<D> operator*(const Enclosure<D>& a, const Enclosure<D>& b) {
  Enclosure<D> y(a.center * b.center);
  y.range = a.range * b.range;
  for (int d = 0; d < D; ++d) y.slopes[d] = a.range * b.slopes[d] + b.range * a.slopes[d];
  return y;
}

template <int D>
Enclosure<D> operator/(const Enclosure<D>& a, const Enclosure<D>& b) {
  const Interval inverse = Inverse(b.range);
  return a * b.Then(1.0 / b.center, inverse, -(inverse * inverse));
}

// With a number on one side.
template <int D>
Enclosure<D> operator+(Enclosure<D> a, double b) {
  a.center += b;
  a.range = {a.range.low + b, a.range.high + b};
  return a;
}
template <int D>
Enclosure<D> operator*(const Enclosure<D>& a, double b) {
  return a.Then(a.center * b, a.range * Interval{b, b}, {b, b});
}
template <int D>
Enclosure<D> operator+(double a, const Enclosure<D>& b) {
  return b + a;
}
template <int D>
Enclosure<D> operator-(const Enclosure<D>& a, double b) {
  return a + -b;
}
template <int D>
Enclosure<D> operator-(double a, const Enclosure<D>& b) {
  return -b + a;
}
template <int D>
Enclosure<D> operator*(double a, const Enclosure<D>& b) {
  return b * a;
}
template <int D>
Enclosure<D> operator/(const Enclosure<D>& a, double b) {
  return a * (1.0 / b);
}
template <int D>
Enclosure<D> operator/(double a, const Enclosure<D>& b) {
  return Enclosure<D>(a) / b;
}

// x >= 0, whatever its interval says.
template <int D>
Enclosure<D> sqrt(const Enclosure<D>& x) {
  const Interval roots = {std::sqrt(std::max(x.range.low, 0.0)),
                          std::sqrt(std::max(x.range.high, 0.0))};
  return x.Then(std::sqrt(std::max(x.center, 0.0)), roots, Interval{0.5, 0.5} * Inverse(roots));
}

template <int D>
Enclosure<D> log(const Enclosure<D>& x) {
  return x.Then(std::log(x.center), {std::log(x.range.low), std::log(x.range.high)},
                Inverse(x.range));
}

// Within one step: boxes are cut where x is a whole number, up to rounding.
template <int D>
Enclosure<D> floor(const Enclosure<D>& x) {
  constexpr double kRounding = 1e-9;
  const double step = std::floor(x.center);
  Enclosure<D> y(step);
  if (x.range.low >= step - kRounding && x.range.high <= step + 1.0 + kRounding) return y;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  y.range = {std::floor(x.range.low), std::floor(x.range.high)};
  y.slopes.fill({-kInfinity, kInfinity});
  return y;
}

// Of an angle within [-4 pi, 4 pi].
template <int D>
Enclosure<D> cos(const Enclosure<D>& x) {
  const auto cosines = [](const Interval& at) {
    Interval values = {std::min(std::cos(at.low), std::cos(at.high)),
                       std::max(std::cos(at.low), std::cos(at.high))};
    for (int k = -4; k <= 4; ++k) {
      if (at.low < k * kPi && k * kPi < at.high)
        (k % 2 == 0 ? values.high : values.low) = k % 2 == 0 ? 1.0 : -1.0;
    }
    return values;
  };
  // cos' = -sin x = cos(x + pi/2).
  return x.Then(std::cos(x.center), cosines(x.range),
                cosines({x.range.low + kPi / 2, x.range.high + kPi / 2}));
}

template <int D>
Enclosure<D> sin(const Enclosure<D>& x) {
  return cos(x - kPi / 2);
}

// Of a point in the first quadrant, whatever its intervals say.
template <int D>
Enclosure<D> atan2(const Enclosure<D>& y, const Enclosure<D>& x) {
  const auto above_zero = [](const Interval& a) {
    return Interval{std::max(a.low, 0.0), std::max(a.high, 0.0)};
  };
  const Interval xs = above_zero(x.range), ys = above_zero(y.range);
  const Interval per_square =
      Inverse({xs.low * xs.low + ys.low * ys.low, xs.high * xs.high + ys.high * ys.high});
  const Interval by_y = xs * per_square, by_x = -(ys * per_square);
  Enclosure<D> angle(std::atan2(y.center, x.center));
  angle.range = {std::atan2(ys.low, xs.high), std::atan2(ys.high, xs.low)};
  for (int d = 0; d < D; ++d) angle.slopes[d] = by_y * y.slopes[d] + by_x * x.slopes[d];
  return angle;
}

// Where the box has both cases, yes and no have to be equal at a = b.
template <int D>
Enclosure<D> IfGreater(const Enclosure<D>& a, const Enclosure<D>& b, const Enclosure<D>& yes,
                       const Enclosure<D>& no) {
  if (a.range.low > b.range.high) return yes;
  if (a.range.high <= b.range.low) return no;
  Enclosure<D> both(a.center > b.center ? yes.center : no.center);
  both.range = Hull(yes.range, no.range);
  for (int d = 0; d < D; ++d) both.slopes[d] = Hull(yes.slopes[d], no.slopes[d]);
  return both;
}

}  // namespace pbnbrdf
