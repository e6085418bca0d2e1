#include "pbnbrdf/problem/energy_strata.h"

#include <cmath>
#include <numbers>

namespace pbnbrdf {

std::vector<EnergyStratum> EqualStrata(const FitProblem& problem) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const int azimuths = IsIsotropic(problem.Shape().encoding()) ? 1 : problem.terms.energy_azimuths;
  std::vector<EnergyStratum> strata;
  for (int k = 0; k < problem.terms.energy_strata; ++k) {
    const double theta_i = std::acos((k + 0.5) / problem.terms.energy_strata);
    for (int p = 0; p < azimuths; ++p) {
      strata.push_back({FromSpherical(theta_i, kTwoPi * p / azimuths),
                        kTwoPi / (problem.terms.energy_strata * azimuths)});
    }
  }
  return strata;
}

AlbedoQuadrature QuadratureOfStratum(const FitProblem& problem, std::size_t k) {
  return AlbedoQuadrature(problem.terms.energy_theta + static_cast<int>(3 * k % 8),
                          problem.terms.energy_phi + static_cast<int>(2 * (k % 5)));
}

}  // namespace pbnbrdf
