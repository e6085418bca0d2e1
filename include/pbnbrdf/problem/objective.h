// objective.h: the cost of a fit, its gradient and its Gauss-Newton matrix at given weights: all
// that any solver needs to know of a fit.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/linearization.h"
#include "pbnbrdf/problem/sampling.h"
#include "problem/energy_term.h"

namespace pbnbrdf {

class Objective {
 public:
  virtual ~Objective() = default;

  virtual const NetworkShape& shape() const = 0;

  // Of the training samples.
  virtual std::size_t num_samples() const = 0;

  // The cost; not finite where the network overflows. weights: shape().num_weights().
  virtual double Cost(const double* weights) = 0;

  // False, with `at` unspecified, if the cost or a derivative isn't finite. Not with
  // Loss::kAbsolute, which has no residuals whose squares add up to the cost.
  virtual bool Linearize(const double* weights, CurvaturePart part, Linearization* at) = 0;
  bool Linearize(const double* weights, Linearization* at) { return Linearize(weights, {}, at); }

  // The cost and its gradient (P; J'r where there are residuals) alone. False, with both unspecified, if they aren't finite.
  virtual bool Gradient(const double* weights, double* cost, double* gradient) = 0;

  // About the largest error of hessian, relative to its diagonal, that rounding makes.
  virtual double HessianRounding() const = 0;

  // Mean over samples and channels of |log1p(f cos_i) - log1p(max(0, f^) cos_i)|.
  virtual double MeanAbsLogError(const double* weights) = 0;

  // Of the energy term so far.
  virtual const EnergyWork& energy_work() const = 0;
};

// `problem` must be valid. strata: of the energy term. Work is shared among the threads that TBB
// grants; the result doesn't depend on their number.
std::unique_ptr<Objective> MakeObjective(const FitProblem& problem,
                                         std::span<const BrdfSample> samples,
                                         std::span<const EnergyStratum> strata);

// With EqualStrata.
std::unique_ptr<Objective> MakeObjective(const FitProblem& problem,
                                         std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
