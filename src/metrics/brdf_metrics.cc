#include "pbnbrdf/metrics/brdf_metrics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/sampling.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;

double SquaredNorm(const Rgb& f, double scale) {
  return (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * scale * scale;
}

// The azimuths phi_h of anisotropic Brdfs.
constexpr int kAzimuths = 8;

// The phi_h over which a mean is taken: any one will do for an isotropic Brdf.
std::vector<double> MeanAzimuths(const Brdf& brdf) {
  if (brdf.IsIsotropic()) return {0.0};
  std::vector<double> azimuths;
  for (int k = 0; k < kAzimuths; ++k) azimuths.push_back(2.0 * kPi * (k + 0.5) / kAzimuths);
  return azimuths;
}

// Mean over channels and a midpoint grid of angles of function(f(pair) - f(swapped pair)). The
// phi_d are (k + offset) pi / n_phi.
template <typename Function>
double MeanDifference(const Brdf& brdf, int n_theta_h, int n_theta_d, int n_phi, double offset,
                      Function function) {
  const std::vector<double> azimuths = MeanAzimuths(brdf);
  std::vector<double> rows(n_theta_h, 0.0);
  tbb::parallel_for(0, n_theta_h, [&](int h) {
    const double t = (h + 0.5) / n_theta_h;
    std::vector<DirectionPair> pairs, swapped;
    for (int d = 0; d < n_theta_d; ++d) {
      for (int p = 0; p < n_phi; ++p) {
        for (double phi_h : azimuths) {
          pairs.push_back(FromAngles({.theta_h = 0.5 * kPi * t * t,
                                      .theta_d = 0.5 * kPi * (d + 0.5) / n_theta_d,
                                      .phi_d = kPi * (p + offset) / n_phi,
                                      .phi_h = phi_h}));
          swapped.push_back(Swapped(pairs.back()));
        }
      }
    }
    std::vector<Rgb> there(pairs.size()), back(pairs.size());
    brdf.EvaluateUnclipped(pairs, there);
    brdf.EvaluateUnclipped(swapped, back);
    const double weight = 2.0 * t / (3.0 * n_theta_h * static_cast<double>(pairs.size()));
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      for (int c = 0; c < 3; ++c) rows[h] += weight * function(there[n][c] - back[n][c]);
    }
  });
  double sum = 0.0;
  for (double row : rows) sum += row;
  return sum;
}

}  // namespace

HeldOutErrors MeasureErrors(const Brdf& reference, const Brdf& test, std::size_t samples,
                            std::uint64_t seed) {
  const std::vector<BrdfSample> drawn =
      DrawSamples(reference, SampleSet::kHeldOut, Sampling::kUniform, samples, seed);
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& s : drawn) pairs.push_back(s.pair);
  std::vector<Rgb> values(pairs.size());
  test.Evaluate(pairs, values);
  HeldOutErrors errors;
  double squares = 0.0;
  for (std::size_t n = 0; n < drawn.size(); ++n) {
    const double cos_i = CosI(pairs[n]);
    const Rgb &f = drawn[n].value, &g = values[n];
    for (int c = 0; c < 3; ++c) {
      errors.mean_abs_log_error += std::abs(std::log1p(f[c] * cos_i) - std::log1p(g[c] * cos_i));
      squares += (f[c] - g[c]) * (f[c] - g[c]) * cos_i * cos_i;
    }
    errors.chromaticity_error +=
        std::abs(std::log1p(SquaredNorm(f, cos_i)) - std::log1p(SquaredNorm(g, cos_i)));
  }
  const double count = static_cast<double>(drawn.size());
  errors.mean_abs_log_error /= 3.0 * count;
  errors.chromaticity_error /= count;
  errors.rmse = std::sqrt(squares / (3.0 * count));
  errors.samples = drawn.size();
  return errors;
}

Reciprocity MeasureReciprocity(const Brdf& brdf) {
  return {.hrl = MeanDifference(brdf, 64, 64, 16, 0.5, [](double x) { return x * x; }),
          .hcl = MeanDifference(brdf, 128, 256, 1, 0.0, [](double x) { return std::abs(x); })};
}

Energy MeasureEnergy(const Brdf& brdf) {
  constexpr int kAngles = 90;
  constexpr double kStep = 0.5 * kPi / kAngles;
  std::vector<Rgb> albedos(kAngles);
  tbb::parallel_for(0, kAngles,
                    [&](int k) { albedos[k] = DirectionalAlbedo(brdf, (k + 0.5) * kStep); });
  Energy energy;
  for (int k = 0; k < kAngles; ++k) {
    const double solid_angle = 2.0 * kPi * std::sin((k + 0.5) * kStep) * kStep;
    for (double a : albedos[k]) {
      energy.max_directional_albedo = std::max(energy.max_directional_albedo, a);
      energy.eal += solid_angle * std::max(0.0, a - 1.0) / 3.0;
    }
  }
  return energy;
}

}  // namespace pbnbrdf
