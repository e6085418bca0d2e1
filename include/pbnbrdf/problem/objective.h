// objective.h: the cost of a fit, its gradient and its Gauss-Newton matrix at given weights: all
// that any solver needs to know of a fit.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/linearization.h"

namespace pbnbrdf {

class EncodedSamples;

// The precision of the network's passes. Residuals, their derivatives and all long sums are always double.
enum class Precision { kSingle, kDouble };

inline constexpr NameTable<Precision, 2> kPrecisions = {
    {{"single", Precision::kSingle}, {"double", Precision::kDouble}}};

// How often a directional albedo and its derivatives were computed, and how often they needn't be.
struct EnergyWork {
  std::int64_t albedos = 0, albedos_skipped = 0;
  std::int64_t jacobians = 0, jacobians_skipped = 0;
};

class Objective {
 public:
  virtual ~Objective() = default;

  virtual const NetworkShape& shape() const = 0;

  // How many of the samples that it was made with it uses.
  virtual std::size_t num_samples() const = 0;

  // Uses the first `count` of these samples from now on, at least num_samples().
  virtual void Grow(std::size_t count) = 0;

  // Sets the weight, >= 0, and the strata of the energy term.
  virtual void SetEnergy(double weight, std::span<const EnergyStratum> strata) = 0;

  // The cost; not finite where the network overflows. weights: shape().num_weights().
  virtual double Cost(const double* weights) = 0;

  // False, with `at` unspecified, if the cost or a derivative isn't finite. Not with
  // Loss::kAbsolute, which has no residuals whose squares add up to the cost.
  virtual bool Linearize(const double* weights, CurvaturePart part, Linearization* at) = 0;
  bool Linearize(const double* weights, Linearization* at) { return Linearize(weights, {}, at); }

  // J'r'' (P), where r'' is the second derivative of the residuals along `direction` (P), weighted as
  // Linearize does: of the terms over samples, and of the same part of them.
  virtual std::vector<double> Curve(const double* weights, const double* direction,
                                    CurvaturePart part) = 0;

  // The cost and its gradient (P; J'r where there are residuals) alone. False, with both unspecified,
  // if they aren't finite.
  virtual bool Gradient(const double* weights, double* cost, double* gradient) = 0;

  // Sums J'J in double precision from now on, whatever the precision of the other passes. False if it did so
  // already.
  virtual bool SumCurvatureInDouble() = 0;

  // About the largest rounding error of the hessian, relative to its diagonal.
  virtual double HessianRounding() const = 0;

  // Mean over samples and channels of |log1p(f cos_i) - log1p(max(0, f^) cos_i)|, whatever the terms.
  virtual double MeanAbsLogError(const double* weights) = 0;

  // The work of the energy term so far.
  virtual const EnergyWork& energy_work() const = 0;
};

// `problem` must be valid. Uses the first `count` of the samples; the energy term starts with the
// problem's weight and EqualStrata. Work is shared among the threads that TBB grants; the result doesn't
// depend on their number. samples must outlive it.
std::unique_ptr<Objective> MakeObjective(const FitProblem& problem, Precision precision,
                                         const EncodedSamples& samples, std::size_t count);

// The same with all samples, which are copied.
std::unique_ptr<Objective> MakeObjective(const FitProblem& problem, Precision precision,
                                         std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
