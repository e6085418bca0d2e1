// linearization.h: a least-squares cost to second order, as Gauss and Newton have it.
#pragma once

#include <cstddef>
#include <vector>

namespace pbnbrdf {

// Which samples J'J is summed over: every count-th batch of them, from batch `index` mod count on,
// scaled up to stand for all. A few samples a weight tell the curvature about as well as all do
// (sub-sampled Gauss-Newton [1]), at a part of the cost; cost and gradient are always of all.
//
// [1] R. Byrd, G. Chin, W. Neveitt, J. Nocedal. On the Use of Stochastic Hessian Information in
//     Optimization Methods for Machine Learning. SIAM J. Optimization 21(3), 2011.
struct CurvaturePart {
  std::size_t index = 0, count = 1;
};

// After robust weighting (rows scaled by sqrt(rho'), as Ceres' corrector does), with J the Jacobian
// of all residuals r, P weights:
struct Linearization {
  double cost = 0.0;             // fit_problem.h
  std::vector<double> gradient;  // J'r, P
  std::vector<double> hessian;   // J'J, P x P, symmetric
};

}  // namespace pbnbrdf
