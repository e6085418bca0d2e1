#include "energy_conservation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/network/fast_neural_brdf.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
// Between the rounds, and in the end.
constexpr AlbedoGrid kRoundGrid = {.angles = 100, .azimuths = 8, .tolerance = 1e-4, .n_phi = 64};
constexpr AlbedoGrid kLastGrid = {.angles = 160, .n_phi = 64};
constexpr double kSameDirection = 0.02;  // radians at the normal, less towards the horizon
constexpr int kStratumSpacing = 3;       // of the grid's directions that become strata
constexpr double kLeastStep = 1e-7;      // of a correction
constexpr int kMostCorrections = 100;

Rgb LargestByChannel(const std::vector<IncidentAlbedo>& profile) {
  Rgb largest = {};
  for (const IncidentAlbedo& at : profile) {
    for (int c = 0; c < 3; ++c) largest[c] = std::max(largest[c], at.albedo[c]);
  }
  return largest;
}

Rgb MeasureLargest(const NetworkShape& shape, const std::vector<double>& weights) {
  return LargestByChannel(AlbedoProfile(NeuralBrdf(shape, weights), kLastGrid));
}

bool IsAnyAbove(const Rgb& albedo, double bound) {
  return std::max({albedo[0], albedo[1], albedo[2]}) > bound;
}

}  // namespace

EnergyConstraints::EnergyConstraints(const FitProblem& problem)
    : problem_(problem), shape_(problem.Shape()), strata_(EqualStrata(problem)) {
  solid_angle_ = strata_.front().solid_angle;
}

double EnergyConstraints::Measure(const std::vector<double>& weights) {
  const FastNeuralBrdf network(NeuralBrdf(shape_, weights));
  profile_ = AlbedoProfile(network, kRoundGrid);
  // What the energy term's own quadrature has to be told.
  const auto fine = AlbedoQuadrature::OnMerlRows(2, 64);
  tbb::parallel_for(std::size_t{0}, strata_.size(), [&](std::size_t k) {
    EnergyStratum& stratum = strata_[k];
    const Rgb exact = DirectionalAlbedo(network, stratum.wi, fine);
    const Rgb own = DirectionalAlbedo(network, stratum.wi, QuadratureOfStratum(problem_, k));
    for (int c = 0; c < 3; ++c) stratum.limit[c] = kMostAlbedo - (exact[c] - own[c]);
  });
  const Rgb largest = LargestByChannel(profile_);
  return std::max({largest[0], largest[1], largest[2]});
}

void EnergyConstraints::Exchange() {
  for (int c = 0; c < 3; ++c) {
    const auto largest = std::max_element(profile_.begin(), profile_.end(),
                                          [c](const IncidentAlbedo& a, const IncidentAlbedo& b) {
                                            return a.albedo[c] < b.albedo[c];
                                          });
    AddStratum(*largest);
  }
  for (std::size_t k = 0; k < profile_.size(); ++k) {
    const bool is_addition = profile_[k].solid_angle == 0.0;
    if (is_addition || k % kStratumSpacing == 0) AddStratum(profile_[k]);
  }
}

// Unless there is one already, or no need of one.
void EnergyConstraints::AddStratum(const IncidentAlbedo& at) {
  if (!IsAnyAbove(at.albedo, kMostAlbedo)) return;
  const Vec3 wi = FromSpherical(at.theta_i, at.phi_i);
  for (const EnergyStratum& stratum : strata_) {
    if (Length(stratum.wi - wi) <= kSameDirection * wi.z) return;
  }
  strata_.push_back({wi, solid_angle_, {kMostAlbedo, kMostAlbedo, kMostAlbedo}});
}

double CorrectionOf(double max_albedo) {
  return std::log((std::max(max_albedo, kMostAlbedo) + kPi) / (kMostAlbedo + kPi));
}

Correction LowerToConserve(const NetworkShape& shape, std::vector<double>* weights) {
  const int last = shape.num_layers() - 1, in = shape.in(last);
  // As a' = exp(-s) (a + S) - S, S = integral of cos_o where f' > 0: at most pi, and less the more
  // is cut off, so that steps which take S for that of the last one don't go too far.
  Rgb support = {kPi, kPi, kPi}, sum = {};
  Rgb largest = MeasureLargest(shape, *weights);
  for (int k = 0; k < kMostCorrections && IsAnyAbove(largest, kMostAlbedo); ++k) {
    Rgb step = {};
    for (int c = 0; c < 3; ++c) {
      if (!(largest[c] > kMostAlbedo)) continue;
      step[c] = std::log((largest[c] + support[c]) / (kMostAlbedo + support[c])) + kLeastStep;
      if (c < shape.num_outputs()) (*weights)[shape.offset(last) + c * (in + 1) + in] -= step[c];
      sum[c] += step[c];
    }
    const Rgb before = largest;
    largest = MeasureLargest(shape, *weights);
    for (int c = 0; c < 3; ++c) {
      if (step[c] == 0.0) continue;
      const double kept = std::exp(-step[c]);
      support[c] = std::clamp((kept * before[c] - largest[c]) / (1.0 - kept), 0.0, kPi);
    }
  }
  return {std::max({sum[0], sum[1], sum[2]}), std::max({largest[0], largest[1], largest[2]})};
}

}  // namespace pbnbrdf
