#include "problem/gap_filler.h"

#include <algorithm>

#include "pbnbrdf/models/fit_analytic.h"

namespace pbnbrdf {
namespace {

constexpr double kOffset = 0.01;  // 1/sr, about a dark diffuse surface
// Of the model's fit, which takes a tenth of a second: more of any doesn't make gaps better.
constexpr std::size_t kMaxSamples = 400;
const AnalyticFitOptions kOptions = {.loss_scale = 0.01,
                                     .first_samples = 100,
                                     .starts = 4,
                                     .max_iterations = 15,
                                     .function_tolerance = 1e-4};

double Raised(double f) { return std::max(f, 0.0) + kOffset; }

AnalyticBrdf FitModel(std::span<const BrdfSample> measurements, bool isotropic) {
  const std::size_t step = (measurements.size() + kMaxSamples - 1) / kMaxSamples;
  std::vector<BrdfSample> some;
  for (std::size_t n = 0; n < measurements.size(); n += step) some.push_back(measurements[n]);
  return FitAnalytic(some, isotropic, FindAnalyticModel("ggx"), kOptions).brdf;
}

ScatteredData Ratios(std::span<const BrdfSample> measurements, bool isotropic, const Brdf& model) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : measurements) pairs.push_back(sample.pair);
  std::vector<Rgb> values(pairs.size());
  model.Evaluate(pairs, values);
  ScatteredData data;
  data.isotropic = isotropic;
  data.samples.assign(measurements.begin(), measurements.end());
  for (std::size_t n = 0; n < values.size(); ++n) {
    for (int c = 0; c < 3; ++c) {
      data.samples[n].value[c] = Raised(data.samples[n].value[c]) / Raised(values[n][c]);
    }
  }
  return data;
}

}  // namespace

GapFiller::GapFiller(std::span<const BrdfSample> measurements, bool isotropic)
    : model_(FitModel(measurements, isotropic)), ratios_(Ratios(measurements, isotropic, model_)) {}

std::vector<BrdfSample> GapFiller::At(const std::vector<DirectionPair>& pairs) const {
  std::vector<Rgb> values(pairs.size()), ratios(pairs.size());
  model_.Evaluate(pairs, values);
  ratios_.EvaluateUnclipped(pairs, ratios);
  std::vector<BrdfSample> samples;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const double certainty = ratios_.Certainty(pairs[n]);
    BrdfSample sample = {pairs[n], {}, std::max(certainty, kMinWeight)};
    for (int c = 0; c < 3; ++c) {
      const double ratio = 1.0 + certainty * (ratios[n][c] - 1.0);
      sample.value[c] = std::max(ratio * Raised(values[n][c]) - kOffset, 0.0);
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace pbnbrdf
