// linearization.h: a least-squares cost to second order, as Gauss and Newton have it.
#pragma once

#include <vector>

namespace pbnbrdf {

// After robust weighting (rows scaled by sqrt(rho'), as Ceres' corrector does), with J the Jacobian
// of all residuals r, P weights:
struct Linearization {
  double cost = 0.0;             // fit_problem.h
  std::vector<double> gradient;  // J'r, P
  std::vector<double> hessian;   // J'J, P x P, symmetric
};

}  // namespace pbnbrdf
