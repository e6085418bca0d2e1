// energy_constraints.h: how a fit ends with no directional albedo above 1, at any incident
// direction: infinitely many constraints, of which only those that matter are kept [1].
//
// From round to round the albedos are measured by a quadrature much finer than the energy term's.
// Each stratum's limit then makes up for what the term's own quadrature misses, and strata are added
// where an albedo is above 1. What is left in the end is removed exactly.
//
// [1] R. Hettich, K. Kortanek. Semi-Infinite Programming: Theory, Methods, and Applications. SIAM
//     Review 35(3), 1993: exchange methods.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/problem/energy_strata.h"

namespace pbnbrdf {

// The largest directional albedo that a fit with the energy term may have by its own check, so that
// other checks, at other angles and by other quadratures, find at most 1 + 1e-6.
inline constexpr double kMaxAlbedo = 1.0 - 2e-5;

class EnergyConstraints {
 public:
  explicit EnergyConstraints(const FitProblem& problem);

  // Measures the network, in single precision. Returns its largest directional albedo.
  double Measure(const std::vector<double>& weights);

  // Adds strata where the albedos that were measured last are too large.
  void Exchange();

  const std::vector<EnergyStratum>& strata() const { return strata_; }

 private:
  void AddStratum(const IncidentAlbedo& at);

  const FitProblem problem_;
  NetworkShape shape_;
  double solid_angle_;
  std::vector<EnergyStratum> strata_;
  std::vector<double> measured_;  // weights, to which the profile belongs
  std::vector<IncidentAlbedo> profile_;
};

// About what LowerToConserve lowers log(1 + f) by if the largest directional albedo is so much.
double CorrectionOf(double max_albedo);

struct Correction {
  double lowered;     // log(1 + f), in the channel where it was lowered most
  double max_albedo;  // the largest directional albedo that is left
};

// Lowers the biases of the last layer, which leaves f' = max(0, (1 + f) exp(-s) - 1) <= f, by about
// the least s of each channel with which no directional albedo is above kMaxAlbedo. A reciprocal
// network stays so.
Correction LowerToConserve(const NetworkShape& shape, std::vector<double>* weights);

}  // namespace pbnbrdf
