// jacobian_methods.h: three ways to the same normal equations of the log term.
#pragma once

#include <functional>
#include <span>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/linearization.h"

namespace pbnbrdf {

enum class DerivativeMethod {
  kAutodiff,   // a Ceres residual block a sample, jets through the whole network; J as a whole
  kDense,      // backward passes write J, 1,024 samples at a time; J'J is Eigen's product
  kCondensed,  // J'J batch by batch without J (normal_equations.h)
};

inline constexpr NameTable<DerivativeMethod, 3> kDerivativeMethods = {
    {{"autodiff", DerivativeMethod::kAutodiff},
     {"dense", DerivativeMethod::kDense},
     {"condensed", DerivativeMethod::kCondensed}}};

// Fills a Linearization at the given weights: cost, J'r and, in its lower triangle, J'J.
using Evaluation = std::function<void(const double* weights, Linearization* at)>;

// To be called by one thread at a time. problem: with the log term alone, its loss not absolute. Autodiff
// is in double precision, the others are in single.
Evaluation MakeEvaluation(DerivativeMethod method, const FitProblem& problem,
                          std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
