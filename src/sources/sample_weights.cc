#include "sources/sample_weights.h"

#include <algorithm>
#include <optional>

#include "base/median.h"

namespace pbnbrdf {
namespace {

// s; none where log1p(f cos_i) isn't defined.
std::optional<double> Deviation(double sigma, const BrdfSample& sample) {
  const double cos_i = sample.pair.wi.z;
  const double f = (sample.value[0] + sample.value[1] + sample.value[2]) / 3.0;
  if (!(cos_i > 0.0 && 1.0 + f * cos_i > 0.0)) return std::nullopt;
  return sigma * cos_i / (1.0 + f * cos_i);
}

}  // namespace

void SetWeights(std::span<const double> sigmas, std::span<BrdfSample> samples) {
  std::vector<double> deviations;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (const auto s = Deviation(sigmas[n], samples[n])) deviations.push_back(*s);
  }
  if (deviations.empty()) return;
  const double median = Median(std::move(deviations));
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const auto s = Deviation(sigmas[n], samples[n]);
    if (!s || *s <= median) continue;
    samples[n].weight = std::max((median / *s) * (median / *s), kLeastWeight);
  }
}

}  // namespace pbnbrdf
