// gradient_check.h: an objective's gradient against numeric differences of its cost.
//
// Along a random direction d the slope g'd is compared with Ridders' extrapolation of central
// differences [1], from several first steps, of which the one with the least error estimate counts.
// The estimate contains the rounding of the cost and the jump from the slope on one side to that on
// the other, extrapolated to a step of 0 from two pairs of steps: at a kink (relu, |r|, albedo = 1)
// near the point it is as large as the kink. A
// direction whose estimate exceeds kResolution is unresolved: it is counted, not judged. What is
// judged is chosen by the cost alone, so a wrong gradient can't hide.
//
// [1] C. Ridders. Accurate computation of F'(x) and F'(x) F''(x). Advances in Engineering Software
//     4(2), 1982.
#pragma once

#include <vector>

#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

struct GradientCheck {
  // Both relative to sum |g_i d_i| or the numeric slope, whichever is larger.
  static constexpr double kResolution = 1e-6;
  double worst_error = 0.0;  // over the resolved directions
  int resolved = 0, unresolved = 0;

  void Add(const GradientCheck& other);
};

// directions: how many, each with components uniform in +-(|w_i| + rms(w) / 10 + 0.001). All are
// unresolved where the cost or its gradient isn't finite. `objective` should be one of double
// precision.
// loss_scale: the problem's. Robust losses are computed as differences of numbers of about its
// square, so that they are rounded as such.
GradientCheck CheckGradient(Objective* objective, double loss_scale,
                            const std::vector<double>& weights, int directions, unsigned seed);

}  // namespace pbnbrdf
