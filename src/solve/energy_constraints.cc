#include "solve/energy_constraints.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "network/fast_neural_brdf.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
// Between the rounds, and in the end.
constexpr AlbedoGrid kRoundGrid = {.angles = 100, .azimuths = 8, .tolerance = 1e-4, .n_phi = 64};
constexpr AlbedoGrid kLastGrid = {.angles = 160, .n_phi = 64};
constexpr double kSameDirection = 0.02;  // radians at the normal, less towards the horizon
constexpr int kStratumSpacing = 3;       // of the grid's directions that become strata
constexpr double kMinStep = 1e-7;        // of a correction
constexpr int kMaxCorrections = 50, kMaxNewtonSteps = 50;
constexpr double kRounding = 2e-6;  // of an albedo in single precision, as seen

const IncidentAlbedo& LargestIn(const std::vector<IncidentAlbedo>& profile, int channel) {
  return *std::max_element(profile.begin(), profile.end(),
                           [channel](const IncidentAlbedo& a, const IncidentAlbedo& b) {
                             return a.albedo[channel] < b.albedo[channel];
                           });
}

// By how much log(1 + f) has to be lowered so that the channel's albedo, which has been measured
// there, becomes the bound.
double LoweringAt(const Brdf& network, const IncidentAlbedo& there, int channel, double bound) {
  static const auto quadrature = AlbedoQuadrature::OnMerlRows(6, 400);
  const std::vector<AlbedoNode> nodes = quadrature.Nodes(FromSpherical(there.theta_i, there.phi_i));
  std::vector<DirectionPair> pairs;
  for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
  std::vector<Rgb> values(pairs.size());
  network.Evaluate(pairs, values);
  double lowering = 0.0;
  for (int k = 0; k < kMaxNewtonSteps; ++k) {
    // The albedo, and minus its derivative, of f' = max(0, (1 + f) exp(-lowering) - 1): convex, so
    // that Newton's steps don't go too far.
    double albedo = 0.0, slope = 0.0;
    const double kept = std::exp(-lowering);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const double lowered = (1.0 + values[n][channel]) * kept;
      if (!(lowered > 1.0)) continue;
      albedo += nodes[n].weight * (lowered - 1.0);
      slope += nodes[n].weight * lowered;
    }
    // These nodes aren't those that it was measured with.
    if (k == 0) bound += albedo - there.albedo[channel];
    if (!(albedo > bound)) break;
    lowering += (albedo - bound) / slope;
  }
  return lowering;
}

// For each channel whose albedo is above the bound somewhere, what the direction where it is largest
// takes.
Rgb Lowering(const Brdf& network, const std::vector<IncidentAlbedo>& profile, double bound) {
  Rgb lowering = {};
  for (int c = 0; c < 3; ++c) {
    const IncidentAlbedo& largest = LargestIn(profile, c);
    if (!(largest.albedo[c] > bound)) continue;
    lowering[c] = LoweringAt(network, largest, c, bound);
  }
  return lowering;
}

}  // namespace

EnergyConstraints::EnergyConstraints(const FitProblem& problem)
    : problem_(problem), shape_(problem.Shape()), strata_(EqualStrata(problem)) {
  solid_angle_ = strata_.front().solid_angle;
}

double EnergyConstraints::Measure(const std::vector<double>& weights) {
  const FastNeuralBrdf network(NeuralBrdf(shape_, weights));
  if (weights != measured_) {
    profile_ = AlbedoProfile(network, kRoundGrid);
    measured_ = weights;
  }
  // What the energy term's own quadrature has to be told.
  const auto fine = AlbedoQuadrature::OnMerlRows(2, 64);
  tbb::parallel_for(std::size_t{0}, strata_.size(), [&](std::size_t k) {
    EnergyStratum& stratum = strata_[k];
    const Rgb exact = DirectionalAlbedo(network, stratum.wi, fine);
    const Rgb own = DirectionalAlbedo(network, stratum.wi, QuadratureOfStratum(problem_, k));
    for (int c = 0; c < 3; ++c) stratum.limit[c] = kMaxAlbedo - (exact[c] - own[c]);
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

// Unless there is one already, or no need of one.
void EnergyConstraints::AddStratum(const IncidentAlbedo& at) {
  if (!(Largest(at.albedo) > kMaxAlbedo)) return;
  const Vec3 wi = FromSpherical(at.theta_i, at.phi_i);
  for (const EnergyStratum& stratum : strata_) {
    if (Length(stratum.wi - wi) <= kSameDirection * wi.z) return;
  }
  strata_.push_back({wi, solid_angle_, {kMaxAlbedo, kMaxAlbedo, kMaxAlbedo}});
}

double CorrectionOf(double max_albedo) {
  return std::log((std::max(max_albedo, kMaxAlbedo) + kPi) / (kMaxAlbedo + kPi));
}

Correction LowerToConserve(const NetworkShape& shape, std::vector<double>* weights) {
  const int last = shape.num_layers() - 1, in = shape.in(last);
  Rgb sum = {};
  double largest = 0.0;
  // In single precision until nothing is left to do; then in double.
  for (bool exactly : {false, true}) {
    const double bound = exactly ? kMaxAlbedo : kMaxAlbedo - kRounding;
    for (int k = 0; k < kMaxCorrections; ++k) {
      const NeuralBrdf exact(shape, *weights);
      const FastNeuralBrdf fast(exact);
      const Brdf& network = exactly ? static_cast<const Brdf&>(exact) : fast;
      const std::vector<IncidentAlbedo> profile = AlbedoProfile(network, kLastGrid);
      largest = Largest(LargestAlbedos(profile));
      if (!(largest > bound)) break;
      const Rgb lowering = Lowering(network, profile, bound);
      for (int c = 0; c < shape.num_outputs(); ++c) {
        if (lowering[c] == 0.0) continue;
        const double step = lowering[c] + std::ldexp(kMinStep, k);  // more, if it goes on and on
        sum[c] += step;
        (*weights)[shape.offset(last) + c * (in + 1) + in] -= step;
      }
    }
  }
  return {Largest(sum), largest};
}

}  // namespace pbnbrdf
