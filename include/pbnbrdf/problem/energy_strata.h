// energy_strata.h: the strata of incident directions that the energy term (eq. 5) sums over.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

struct EnergyStratum {
  Vec3 wi;                      // the direction that stands for the stratum
  double solid_angle;           // > 0, sr
  Rgb limit = {1.0, 1.0, 1.0};  // the largest directional albedo that costs nothing
};

// energy_strata of the terms' options values of cos theta_i, in the middle of equal parts of [0, 1], and for
// anisotropic encodings energy_azimuths phi_i with each: equal in solid angle.
std::vector<EnergyStratum> EqualStrata(const FitProblem& problem);

// The energy term's quadrature for the k-th stratum: energy_theta x energy_phi nodes, or a
// few more, so that no two neighbours have theirs in the same places: where they do, a network
// learns to be dark at the nodes and bright in between.
AlbedoQuadrature QuadratureOfStratum(const FitProblem& problem, std::size_t k);

}  // namespace pbnbrdf
