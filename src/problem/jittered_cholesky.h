// jittered_cholesky.h: a factor of a symmetric matrix that is positive semidefinite but for
// rounding.
#pragma once

#include "kernels/cholesky.h"

namespace pbnbrdf {

// Lower triangular L with L L' = A + jitter * diag(A). J'J of a network with a dead unit is
// singular. A row of A that is zero (its weight moves nothing) counts as having the smallest
// positive diagonal, or 1 if there is none.
struct JitteredCholesky {
  Cholesky lower;
  double jitter = 0.0;  // the least of first_jitter, 10 first_jitter, ... that factors
};

// a: size x size, symmetric, finite, semidefinite but for rounding. first_jitter > 0: about the
// relative rounding error of a.
JitteredCholesky FactorWithJitter(const double* a, int size, double first_jitter);

}  // namespace pbnbrdf
