#include "models/analytic_starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pbnbrdf {
namespace {

constexpr double kDarkerPart = 0.3;  // of the samples, the brightest of which is the diffuse part
constexpr double kBrighterPart = 0.02;  // of the samples: the highlight
constexpr double kFaint = 1e-4;         // scale of a lobe
constexpr double kWidthOfSecond = 0.5;  // part of the way from the first lobe's width to `wide`

// The channel's value that the given part of the samples doesn't exceed.
double Quantile(std::span<const BrdfSample> samples, int channel, double part) {
  std::vector<double> values;
  for (const BrdfSample& sample : samples) values.push_back(sample.value[channel]);
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// place: 0 the narrowest, 1 the widest.
double WidthAt(const ModelParameter& parameter, double place) {
  return parameter.narrow * std::pow(parameter.wide / parameter.narrow, place);
}

// The channel's factor by which the lobes alone, with scale 1, are as bright as the highlight
// beyond the diffuse part.
double LobeFactor(const AnalyticModel& model, int lobes, const std::vector<double>& scalars,
                  std::span<const BrdfSample> samples, int channel, double diffuse) {
  const double bright = Quantile(samples, channel, 1.0 - kBrighterPart);
  double sum = 0.0, lobe_sum = 0.0;
  for (const BrdfSample& sample : samples) {
    if (sample.value[channel] < bright) continue;
    sum += std::max(0.0, sample.value[channel] - diffuse);
    lobe_sum +=
        model.evaluate(ReflectionGeometry(sample.pair), scalars.data(), lobes)[channel] - diffuse;
  }
  return lobe_sum > 0.0 ? sum / lobe_sum : 1.0;
}

std::vector<double> StartAt(const AnalyticModel& model, int lobes,
                            std::span<const BrdfSample> samples, double place) {
  const std::vector<PlacedParameter> all = PlacedParameters(model, lobes);
  std::vector<double> scalars(
      static_cast<std::size_t>(model.BaseSize() + lobes * model.LobeSize()));
  Rgb diffuse = {};
  for (const PlacedParameter& placed : all) {
    const ModelParameter& parameter = *placed.parameter;
    const double width_place = placed.lobe == 0 ? place : place + kWidthOfSecond * (1.0 - place);
    for (int c = 0; c < parameter.size; ++c) {
      double& scalar = scalars[placed.first + static_cast<std::size_t>(c)];
      scalar = parameter.initial;
      if (parameter.role == FitRole::kScale) scalar = 1.0;
      if (parameter.role == FitRole::kWidth) scalar = WidthAt(parameter, width_place);
      if (parameter.role == FitRole::kDiffuse) {
        diffuse[c] = Quantile(samples, c, kDarkerPart);
        scalar = std::clamp(diffuse[c] * std::numbers::pi, parameter.lower, parameter.upper);
      }
    }
  }
  for (const PlacedParameter& placed : all) {
    if (placed.parameter->role != FitRole::kScale) continue;
    for (int c = 0; c < 3; ++c) {
      const double factor = LobeFactor(model, lobes, scalars, samples, c, diffuse[c]);
      scalars[placed.first + static_cast<std::size_t>(c)] =
          std::clamp(std::isfinite(factor) ? factor : 1.0, kFaint, placed.parameter->upper);
    }
  }
  return scalars;
}

}  // namespace

std::vector<std::vector<double>> AnalyticStarts(const AnalyticModel& model, int lobes,
                                                std::span<const BrdfSample> samples, int count) {
  std::vector<std::vector<double>> starts;
  for (int k = 0; k < count; ++k) {
    starts.push_back(StartAt(model, lobes, samples, (k + 0.5) / count));
  }
  return starts;
}

std::vector<double> WithFaintLobe(const AnalyticModel& model, std::vector<double> scalars) {
  for (const ModelParameter& parameter : model.lobe) {
    const double value = parameter.role == FitRole::kScale   ? kFaint
                         : parameter.role == FitRole::kWidth ? WidthAt(parameter, kWidthOfSecond)
                                                             : parameter.initial;
    scalars.insert(scalars.end(), static_cast<std::size_t>(parameter.size), value);
  }
  return scalars;
}

}  // namespace pbnbrdf
