#include "pbnbrdf/problem/energy_strata.h"

#include <cmath>
#include <numbers>

namespace pbnbrdf {

std::vector<EnergyStratum> EqualStrata(const FitProblem& problem) {
  constexpr double kTwoPi = 2.0 * std::numbers::pi;
  const int azimuths = IsIsotropic(problem.encoding) ? 1 : problem.energy_azimuths;
  std::vector<EnergyStratum> strata;
  for (int k = 0; k < problem.energy_strata; ++k) {
    const double theta_i = std::acos((k + 0.5) / problem.energy_strata);
    for (int p = 0; p < azimuths; ++p) {
      strata.push_back({FromSpherical(theta_i, kTwoPi * p / azimuths),
                        kTwoPi / (problem.energy_strata * azimuths)});
    }
  }
  return strata;
}

AlbedoQuadrature QuadratureOfStratum(const FitProblem& problem, std::size_t k) {
  return AlbedoQuadrature(problem.energy_theta + static_cast<int>(3 * k % 8),
                          problem.energy_phi + static_cast<int>(2 * (k % 5)));
}

}  // namespace pbnbrdf
