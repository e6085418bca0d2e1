#include "pbnbrdf/brdf/importance_sampler.h"

#include <cmath>
#include <numbers>

#include "brdf/ggx_reflections.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 DrawCosine(const std::array<double, 2>& u) {
  const double r = std::sqrt(u[0]), phi = 2.0 * kPi * u[1];
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0 - u[0])};
}

void CheckWidth(const char* name, double alpha) {
  if (!(alpha >= LobeProposal::kLeastWidth && alpha <= LobeProposal::kMostWidth)) {
    Fail(name, " = ", alpha, "; must be ", LobeProposal::kLeastWidth, " to ",
         LobeProposal::kMostWidth);
  }
}

double Density(const LobeProposal& proposal, const DirectionPair& pair) {
  if (!pair.AboveHorizon()) return 0.0;
  const double lobe = proposal.lobe_weight > 0.0 ? GgxReflectionDensity(pair, proposal.alpha) : 0.0;
  return proposal.lobe_weight * lobe + (1.0 - proposal.lobe_weight) * pair.wo.z / kPi;
}

}  // namespace

ImportanceSampler::ImportanceSampler(const LobeProposal& proposal) : proposal_(proposal) {
  CheckWidth("alpha_x", proposal.alpha.x);
  CheckWidth("alpha_y", proposal.alpha.y);
  if (!(proposal.lobe_weight >= 0.0 && proposal.lobe_weight <= 1.0)) {
    Fail("lobe_weight = ", proposal.lobe_weight, "; must be 0 to 1");
  }
}

Vec3 ImportanceSampler::Draw(const Vec3& wi, const std::array<double, 2>& u) const {
  // u[0] chooses between the two, and what it has left is uniform again.
  const double w = proposal_.lobe_weight;
  if (u[0] < w) return DrawGgxReflection(wi, proposal_.alpha, {u[0] / w, u[1]});
  return DrawCosine({(u[0] - w) / (1.0 - w), u[1]});
}

void ImportanceSampler::Sample(std::span<const Vec3> wi, std::span<const std::array<double, 2>> u,
                               std::span<Vec3> wo, std::span<double> pdf) const {
  for (std::size_t n = 0; n < wi.size(); ++n) {
    if (wi[n].z > 0.0) {
      wo[n] = Draw(wi[n], u[n]);
      pdf[n] = Density(proposal_, {wi[n], wo[n]});
    } else {
      wo[n] = {0.0, 0.0, 1.0};
      pdf[n] = 0.0;
    }
  }
}

void ImportanceSampler::Pdf(std::span<const DirectionPair> pairs, std::span<double> pdf) const {
  for (std::size_t n = 0; n < pairs.size(); ++n) pdf[n] = Density(proposal_, pairs[n]);
}

}  // namespace pbnbrdf
