// energy_constraints.h: that no directional albedo is above 1, at any incident direction: infinitely many
// constraints, of which only those that matter are kept [1].
//
// The albedos are measured by a quadrature much finer than the energy term's. Each stratum's limit then makes
// up for what the term's own quadrature misses, and strata are added where an albedo is above 1.
//
// [1] R. Hettich, K. Kortanek. Semi-Infinite Programming: Theory, Methods, and Applications. SIAM
//     Review 35(3), 1993: exchange methods.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "solve/energy_correction.h"

namespace pbnbrdf {

class EnergyConstraints {
 public:
  explicit EnergyConstraints(const FitProblem& problem);

  // Measures the network, in single precision. Returns its largest directional albedo.
  double Measure(const NeuralBrdf& network);

  // Adds strata where the albedos that were measured last are too large.
  void Exchange();

  // Aims at albedos smaller by this, from the next Measure on.
  void LowerTarget(double by) { target_ -= by; }

  const std::vector<EnergyStratum>& strata() const { return strata_; }

 private:
  void AddStratum(const IncidentAlbedo& at);

  const FitProblem problem_;
  double solid_angle_;
  double target_ = kTargetAlbedo;
  std::vector<EnergyStratum> strata_;
  std::vector<double> measured_;  // weights, to which the profile belongs
  std::vector<IncidentAlbedo> profile_;
};

}  // namespace pbnbrdf
