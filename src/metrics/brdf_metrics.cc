#include "pbnbrdf/metrics/brdf_metrics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/pi.h"
#include "metrics/mean.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/metrics/color.h"

namespace pbnbrdf {
namespace {

constexpr double kDarkLuminance = 0.1;
constexpr double kVisiblePercentile = 0.95;

std::vector<Rgb> ValuesAt(std::span<const BrdfSample> samples, const Brdf& brdf) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& s : samples) pairs.push_back(s.pair);
  std::vector<Rgb> values(pairs.size());
  brdf.Evaluate(pairs, values);
  return values;
}

double SquaredNorm(const Rgb& f, double scale) {
  return (f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) * scale * scale;
}

// NaN stays NaN.
Rgb LitColor(const Rgb& f, double cos_i) {
  Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = std::clamp(kPi * f[c] * cos_i, 0.0, 1.0);
  return color;
}

// The least of the values that so many of them don't exceed; NaN counts as the largest.
double Percentile(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const double rank = std::ceil(kVisiblePercentile * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(values.begin(), at, values.end(),
                   [](double x, double y) { return std::isnan(y) ? !std::isnan(x) : x < y; });
  return *at;
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

// Mean over channels and a midpoint grid of angles of function(f(pair) - f(swapped pair)), which counts as 0
// above the horizon where f isn't known, as at grazing angles of measurements. The
// phi_d are (k + offset) pi / n_phi.
template <typename Function>
double MeanDifference(const Brdf& brdf, int n_theta_h, int n_theta_d, int n_phi, double offset,
                      Function function) {
  const std::vector<double> azimuths = MeanAzimuths(brdf);
  std::vector<double> rows(n_theta_h, 0.0);
  ParallelFor(rows.size(), [&](std::size_t h) {
    const double t = (static_cast<double>(h) + 0.5) / n_theta_h;
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
      if (pairs[n].AboveHorizon() && !(brdf.IsKnown(pairs[n]) && brdf.IsKnown(swapped[n])))
        continue;
      for (int c = 0; c < 3; ++c) rows[h] += weight * function(there[n][c] - back[n][c]);
    }
  });
  double sum = 0.0;
  for (double row : rows) sum += row;
  return sum;
}

}  // namespace

HeldOutErrors MeasureErrors(std::span<const BrdfSample> reference, const Brdf& test) {
  const std::vector<Rgb> values = ValuesAt(reference, test);
  HeldOutErrors errors;
  double squares = 0.0, differences = 0.0, magnitudes = 0.0;
  for (std::size_t n = 0; n < reference.size(); ++n) {
    const double cos_i = CosI(reference[n].pair);
    const Rgb &f = reference[n].value, &g = values[n];
    for (int c = 0; c < 3; ++c) {
      errors.mean_abs_log_error += std::abs(std::log1p(f[c] * cos_i) - std::log1p(g[c] * cos_i));
      squares += (f[c] - g[c]) * (f[c] - g[c]) * cos_i * cos_i;
      differences += std::abs(f[c] - g[c]) * cos_i;
      magnitudes += std::abs(f[c]) * cos_i;
    }
    errors.chromaticity_error +=
        std::abs(std::log1p(SquaredNorm(f, cos_i)) - std::log1p(SquaredNorm(g, cos_i)));
  }
  const double count = static_cast<double>(reference.size());
  errors.mean_abs_log_error /= 3.0 * count;
  errors.chromaticity_error /= count;
  errors.rmse = std::sqrt(squares / (3.0 * count));
  if (differences > 0.0) {
    errors.relative_error = magnitudes > 0.0 ? differences / magnitudes : 1.0;
  }
  errors.samples = reference.size();
  return errors;
}

double ReciprocalFloor(std::span<const BrdfSample> samples, const Brdf& material) {
  std::vector<BrdfSample> swapped(samples.begin(), samples.end());
  for (BrdfSample& sample : swapped) sample.pair = Swapped(sample.pair);
  const std::vector<Rgb> back = ValuesAt(swapped, material);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (!material.IsKnown(swapped[n].pair)) continue;
    const double cos_i = CosI(samples[n].pair);
    for (int c = 0; c < 3; ++c) {
      sum += std::abs(std::log1p(samples[n].value[c] * cos_i) - std::log1p(back[n][c] * cos_i));
    }
    count += 3;
  }
  return count > 0 ? 0.5 * sum / static_cast<double>(count) : 0.0;
}

ColorErrors MeasureColorErrors(std::span<const BrdfSample> reference, const Brdf& test) {
  const std::vector<Rgb> values = ValuesAt(reference, test);
  std::vector<double> delta_e(reference.size()), dark;
  for (std::size_t n = 0; n < reference.size(); ++n) {
    const double cos_i = CosI(reference[n].pair);
    const Rgb wanted = LitColor(reference[n].value, cos_i);
    const Lab x = ToLab(wanted), y = ToLab(LitColor(values[n], cos_i));
    delta_e[n] = DeltaE2000(x, y);
    if (Luminance(wanted) <= kDarkLuminance) dark.push_back(HueChromaDifference(x, y));
  }
  ColorErrors errors;
  errors.samples = delta_e.size();
  errors.dark_samples = dark.size();
  errors.delta_e_mean = Mean(delta_e);
  errors.delta_e_p95 = Percentile(std::move(delta_e));
  errors.dark_hue_chroma_mean = Mean(dark);
  errors.dark_hue_chroma_p95 = Percentile(std::move(dark));
  return errors;
}

Reciprocity MeasureReciprocity(const Brdf& brdf) {
  return {.hrl = MeanDifference(brdf, 64, 64, 16, 0.5, [](double x) { return x * x; }),
          .hcl = MeanDifference(brdf, 128, 256, 1, 0.0, [](double x) { return std::abs(x); })};
}

Energy MeasureEnergy(const Brdf& brdf, const AlbedoGrid& grid) {
  return EnergyOf(AlbedoProfile(brdf, grid));
}

Energy EnergyOf(const std::vector<IncidentAlbedo>& profile) {
  Energy energy;
  for (const IncidentAlbedo& at : profile) {
    for (int c = 0; c < 3; ++c) {
      energy.eal += at.solid_angle * std::max(0.0, at.albedo[c] - 1.0) / 3.0;
      if (!(at.albedo[c] > energy.max_directional_albedo)) continue;
      energy.max_directional_albedo = at.albedo[c];
      energy.theta_i = at.theta_i;
      energy.phi_i = at.phi_i;
      energy.channel = c;
    }
  }
  return energy;
}

}  // namespace pbnbrdf
