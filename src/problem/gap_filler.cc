#include "problem/gap_filler.h"

#include <algorithm>

#include "pbnbrdf/models/fit_analytic.h"

namespace pbnbrdf {
namespace {

// 1/sr. Below it ratios become differences, which noise about 0 leaves unbiased.
constexpr double kOffset = 0.03;
constexpr double kMinRatio = -0.99;  // a value that ScatteredBrdf takes
// Of the model's fit, which takes a few tenths of a second: more of any doesn't make gaps better. A second lobe
// helps where it explains something (Cornell's paints: a fifth to a half of the cost), and harms where it doesn't.
constexpr std::size_t kMaxFitted = 400, kBrightest = 100;
const AnalyticFitOptions kOptions = {.lobes = 2,
                                     .loss_scale = 0.01,
                                     .first_samples = 100,
                                     .starts = 4,
                                     .max_iterations = 15,
                                     .function_tolerance = 1e-4,
                                     .lobe_gain = 0.1};

// Of the measurements, the brightest ones, as a peak is easily missed, and of the others every so many.
std::vector<BrdfSample> Some(std::span<const BrdfSample> measurements) {
  std::vector<BrdfSample> some(measurements.begin(), measurements.end());
  if (some.size() <= kMaxFitted) return some;
  std::stable_sort(some.begin(), some.end(), [](const BrdfSample& a, const BrdfSample& b) {
    return Largest(a.value) > Largest(b.value);
  });
  const std::size_t rest = some.size() - kBrightest, wanted = kMaxFitted - kBrightest;
  for (std::size_t k = 0; k < wanted; ++k)
    some[kBrightest + k] = some[kBrightest + k * rest / wanted];
  some.resize(kMaxFitted);
  return some;
}

std::shared_ptr<const Brdf> FitModel(std::span<const BrdfSample> measurements, bool isotropic) {
  return std::make_shared<AnalyticBrdf>(
      FitAnalytic(Some(measurements), isotropic, FindAnalyticModel("ggx"), kOptions).brdf);
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
      data.samples[n].value[c] =
          std::max((data.samples[n].value[c] + kOffset) / (values[n][c] + kOffset), kMinRatio);
    }
  }
  return data;
}

}  // namespace

GapFiller::GapFiller(std::span<const BrdfSample> measurements, bool isotropic,
                     std::shared_ptr<const Brdf> model)
    : model_(model ? std::move(model) : FitModel(measurements, isotropic)),
      ratios_(Ratios(measurements, isotropic, *model_)) {}

std::vector<BrdfSample> GapFiller::At(const std::vector<DirectionPair>& pairs) const {
  std::vector<Rgb> values(pairs.size()), ratios(pairs.size());
  model_->Evaluate(pairs, values);
  ratios_.EvaluateUnclipped(pairs, ratios);
  std::vector<BrdfSample> samples;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const double certainty = ratios_.Certainty(pairs[n]);
    BrdfSample sample = {pairs[n], {}, std::max(certainty, kMinWeight)};
    for (int c = 0; c < 3; ++c) {
      const double ratio = 1.0 + certainty * (ratios[n][c] - 1.0);
      sample.value[c] = ratio * (values[n][c] + kOffset) - kOffset;
    }
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace pbnbrdf
