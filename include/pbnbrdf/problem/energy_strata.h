// energy_strata.h: the energy term (eq. 5) over strata of incident angles, for the fast path.
#pragma once

#include <vector>

#include "pbnbrdf/network/batched_mlp.h"
#include "pbnbrdf/network/encoded_batches.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "pbnbrdf/problem/linearization.h"

namespace pbnbrdf {

// The incident angle of stratum k of `strata`, equal in solid angle (2 pi / strata): uniform in
// cos theta_i, at the middle.
double StratumAngle(int k, int strata);

// 1/2 weight sum over strata k and channels of r^2, r as in residuals/energy_residual.h; with
// Loss::kAbsolute weight times eq. 5, the mean over channels. The nodes of the quadrature don't move
// while fitting: they are encoded once.
template <typename T>
class EnergyStrata {
 public:
  // Empty if problem.energy_weight is 0: all costs are then 0.
  explicit EnergyStrata(const FitProblem& problem);

  double Cost(const T* weights) const;

  // Adds the term's cost, gradient and, unless at->hessian is empty, J'J. Only strata whose albedo
  // exceeds 1 have derivatives.
  void Linearize(const T* weights, Linearization* at) const;

  // The directional albedo of each stratum.
  std::vector<Rgb> Albedos(const T* weights) const;

 private:
  struct Stratum {
    EncodedBatches<T> inputs;
    std::vector<double> node_weights;
  };

  Rgb Albedo(const T* weights, const Stratum& stratum) const;
  void AlbedoGradients(const T* weights, const Stratum& stratum, double* gradients) const;

  NetworkShape shape_;
  // The cost and its slope for an albedo that exceeds 1 by so much.
  double CostOf(double excess) const;
  double SlopeOf(double excess) const;

  bool absolute_ = false;
  double weight_ = 0.0;  // with the solid angle of a stratum
  std::vector<Stratum> strata_;
};

extern template class EnergyStrata<float>;
extern template class EnergyStrata<double>;

}  // namespace pbnbrdf
