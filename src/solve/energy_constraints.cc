#include "solve/energy_constraints.h"

#include "base/parallel.h"

namespace pbnbrdf {
namespace {

// Between the rounds.
constexpr AlbedoGrid kRoundGrid = {.angles = 100, .azimuths = 8, .tolerance = 1e-4, .n_phi = 64};
constexpr double kSameDirection = 0.02;  // radians at the normal, less towards the horizon
constexpr int kStratumSpacing = 3;       // of the grid's directions that become strata

}  // namespace

EnergyConstraints::EnergyConstraints(const FitProblem& problem)
    : problem_(problem), strata_(EqualStrata(problem)) {
  solid_angle_ = strata_.front().solid_angle;
}

double EnergyConstraints::Measure(const NeuralBrdf& network) {
  const std::unique_ptr<Brdf> single = network.SinglePrecision();
  if (network.weights() != measured_) {
    profile_ = AlbedoProfile(*single, kRoundGrid);
    measured_ = network.weights();
  }
  // A limit makes up for the error of the energy term's own quadrature, which is coarser.
  const auto fine = AlbedoQuadrature::OnMerlRows(2, 64);
  ParallelFor(strata_.size(), [&](std::size_t k) {
    EnergyStratum& stratum = strata_[k];
    const Rgb exact = DirectionalAlbedo(*single, stratum.wi, fine);
    const Rgb own = DirectionalAlbedo(*single, stratum.wi, QuadratureOfStratum(problem_, k));
    for (int c = 0; c < 3; ++c) stratum.limit[c] = target_ - (exact[c] - own[c]);
  });
  return Largest(LargestAlbedos(profile_));
}

void EnergyConstraints::Exchange() {
  for (int c = 0; c < 3; ++c) AddStratum(LargestIn(profile_, c));
  for (std::size_t k = 0; k < profile_.size(); ++k) {
    const bool is_addition = profile_[k].solid_angle == 0.0;
    if (is_addition || k % kStratumSpacing == 0) AddStratum(profile_[k]);
  }
}

// Unless there is one nearby, or the albedo there is small enough.
void EnergyConstraints::AddStratum(const IncidentAlbedo& at) {
  if (!(Largest(at.albedo) > target_)) return;
  const Vec3 wi = FromSpherical(at.theta_i, at.phi_i);
  for (const EnergyStratum& stratum : strata_) {
    if (Length(stratum.wi - wi) <= kSameDirection * wi.z) return;
  }
  strata_.push_back({wi, solid_angle_, {target_, target_, target_}});
}

}  // namespace pbnbrdf
