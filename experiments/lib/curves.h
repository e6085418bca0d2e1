// curves.h: curves of error against time, and medians.
#pragma once

#include <vector>

namespace pbnbrdf {

struct CurvePoint {
  double seconds, error;
};

// In the order of time. The error of a point holds until the next point, that of the last one for ever.
using Curve = std::vector<CurvePoint>;

// Infinite before the first point.
double ErrorAt(const Curve& curve, double seconds);

// When the error is first at most `error`; infinite if it never is.
double TimeToError(const Curve& curve, double error);

// The median of the curves' errors at `count` >= 2 times, in equal ratios from the first point of
// any to the last of any; from where more than half of the curves have begun.
Curve MedianCurve(const std::vector<Curve>& curves, int count);

}  // namespace pbnbrdf
