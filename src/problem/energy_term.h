// energy_term.h: the energy term (eq. 5) over strata of incident directions, for the fast path.
#pragma once

#include <span>
#include <vector>

#include "network/batched_mlp.h"
#include "network/encoded_batches.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/linearization.h"
#include "pbnbrdf/problem/objective.h"

namespace pbnbrdf {

// 1/2 weight sum over strata k and channels of r^2, r as in residuals/energy_residual.h; with
// Loss::kAbsolute weight times eq. 5, the mean over channels. The nodes of the quadrature don't move
// while fitting: they are encoded once.
//
// Only strata above their limit have derivatives. With TermOptions::energy_skip, those that were far
// below it (kFar) are taken to be so still, and looked at again at every kRecheck-th Linearize: that
// changes the result only if an albedo grows by kFar in between and falls again.
template <typename T>
class EnergyTerm {
 public:
  static constexpr double kFar = 0.1;
  static constexpr int kRecheck = 8;

  // Empty until it is set: all costs are then 0.
  explicit EnergyTerm(const FitProblem& problem) : problem_(problem), shape_(problem.Shape()) {}

  // weight: 0 for no term. A stratum in the place and direction of one that there was keeps its nodes.
  void Set(double weight, std::span<const EnergyStratum> strata);

  double Cost(const T* weights);

  // Adds the term's cost, gradient and, unless at->hessian is empty, J'J.
  void Linearize(const T* weights, Linearization* at);

  const EnergyWork& work() const { return work_; }

 private:
  struct Stratum {
    Vec3 wi;
    EncodedBatches<T> inputs;
    std::vector<double> node_weights;
    double weight;  // of the term, with the solid angle
    Rgb limit;
    Rgb excess = {};      // over the limit, when last computed; negative below it
    bool watched = true;  // whether it isn't far below
  };

  void UpdateExcesses(const T* weights, bool of_all);
  Rgb Albedo(const T* weights, const Stratum& stratum) const;
  void AlbedoGradients(const T* weights, const Stratum& stratum, double* gradients) const;
  double CostOf(const Stratum& stratum) const;

  Stratum Encoded(const Vec3& wi, std::size_t k) const;
  bool IsAbsolute() const { return problem_.terms.loss == Loss::kAbsolute; }

  FitProblem problem_;
  NetworkShape shape_;
  double weight_ = 0.0;
  std::vector<Stratum> strata_;
  int linearizations_ = 0;
  EnergyWork work_;
};

extern template class EnergyTerm<float>;
extern template class EnergyTerm<double>;

}  // namespace pbnbrdf
