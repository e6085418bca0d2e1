// jittered_cholesky.h: a factor of a symmetric matrix that is positive semidefinite but for rounding.
#pragma once

#include <Eigen/Core>

namespace pbnbrdf {

// Lower triangular L with L L' = A + jitter * diag(A), jitter the least of 0, 1e-15, 1e-14, ... that
// factors. J'J of a network with a dead unit is singular. A row of A that is zero (its weight moves
// nothing) counts as having a diagonal of the smallest positive one, or of 1 if there is none.
struct JitteredCholesky {
  Eigen::MatrixXd lower;
  double jitter = 0.0;
};

// a: symmetric, finite, only its lower triangle is read. Throws nothing; a jitter of 1 always factors
// a matrix that is semidefinite to rounding.
JitteredCholesky FactorWithJitter(const Eigen::MatrixXd& a);

}  // namespace pbnbrdf
