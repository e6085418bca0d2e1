// family_step.h: a damped step of Gauss and Newton for all unknowns of a shared network.
#pragma once

#include "database/family_point.h"

namespace pbnbrdf {

struct FamilyStep {
  FamilyPoint change;
  double predicted = 0.0;  // decrease of the cost
};

// Minimises the quadratic model at the point with `ridge` / 2 times the squared codes added and damping
// diag / radius, by conjugate gradients [1]. They are preconditioned by the blocks of single columns of the weights, and of
// single codes: with those solved exactly, some dozen iterations take the residual to a hundredth or less.
//
// [1] J. Nocedal, S. Wright. Numerical Optimization. Springer 2006, chapter 5.
FamilyStep DampedStep(const FamilyPoint& point, const FamilyLinearization& at, double ridge,
                      double radius);

}  // namespace pbnbrdf
