#include "curves.h"
#include "base/median.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbnbrdf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMinSeconds = 1e-6;  // a ratio of times needs one that isn't 0

}  // namespace

double ErrorAt(const Curve& curve, double seconds) {
  const auto after =
      std::upper_bound(curve.begin(), curve.end(), seconds,
                       [](double time, const CurvePoint& point) { return time < point.seconds; });
  return after == curve.begin() ? kInfinity : std::prev(after)->error;
}

double TimeToError(const Curve& curve, double error) {
  const auto reached = std::find_if(curve.begin(), curve.end(),
                                    [&](const CurvePoint& point) { return point.error <= error; });
  return reached == curve.end() ? kInfinity : reached->seconds;
}

Curve MedianCurve(const std::vector<Curve>& curves, int count) {
  double first = kInfinity, last = 0.0;
  for (const Curve& curve : curves) {
    if (curve.empty()) continue;
    first = std::min(first, std::max(curve.front().seconds, kMinSeconds));
    last = std::max(last, curve.back().seconds);
  }
  Curve medians;
  for (int k = 0; k < count && first <= last; ++k) {
    const double seconds =
        k + 1 < count ? first * std::pow(last / first, k / (count - 1.0)) : last;  // exactly
    std::vector<double> errors;
    for (const Curve& curve : curves) errors.push_back(ErrorAt(curve, seconds));
    const double median = Median(errors);
    if (std::isfinite(median)) medians.push_back({seconds, median});
  }
  return medians;
}

}  // namespace pbnbrdf
