#include "pbnbrdf/brdf/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/half_diff.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kBatch = 1024;
constexpr std::size_t kDrawsPerKnown = 10000;

// Uniform on the grid (k + 1/2) 2^-32; std::uniform_real_distribution differs between libraries.
double Uniform(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 32) + 0.5) * 0x1p-32;
}

// The same on the points with even k (training) or odd k (held out).
double UniformOf(SampleSet set, std::mt19937_64& random) {
  const std::uint64_t even = (random() >> 33) << 1;
  return (static_cast<double>(even + (set == SampleSet::kHeldOut)) + 0.5) * 0x1p-32;
}

double DrawThetaH(Sampling sampling, std::mt19937_64& random) {
  const double u = Uniform(random);
  if (sampling == Sampling::kUniform) return 0.5 * kPi * u;
  return 0.5 * kPi * (u < 0.5 ? 2.0 * u : std::pow(2.0 * u - 1.0, 4));
}

bool IsUsable(const Rgb& value) {
  return std::all_of(value.begin(), value.end(),
                     [](double v) { return v >= 0.0 && std::isfinite(v); });
}

}  // namespace

void SampleStream::Draw(std::size_t count, std::vector<BrdfSample>* samples) {
  const std::size_t end = samples->size() + count;
  samples->reserve(end);
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> values(kBatch);
  for (std::size_t drawn = 0; samples->size() < end; ++drawn) {
    const std::size_t missing = end - samples->size();
    if (drawn >= kDrawsPerKnown * (count - missing + 100)) {
      Fail("too little data: ", count - missing, " of ", drawn, " random angles are known");
    }
    RusinkiewiczAngles angles;
    angles.theta_h = DrawThetaH(sampling_, random_);
    angles.theta_d = 0.5 * kPi * UniformOf(set_, random_);
    angles.phi_d = 2.0 * kPi * Uniform(random_);
    if (!brdf_.IsIsotropic()) angles.phi_h = 2.0 * kPi * Uniform(random_);
    const DirectionPair pair = FromAngles(angles);
    if (brdf_.IsKnown(pair)) pairs.push_back(pair);
    if (pairs.size() < std::min(kBatch, missing)) continue;
    brdf_.Evaluate(pairs, std::span(values).first(pairs.size()));
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      if (IsUsable(values[n])) samples->push_back({pairs[n], values[n]});
    }
    pairs.clear();
  }
}

std::vector<BrdfSample> DrawSamples(const Brdf& brdf, SampleSet set, Sampling sampling,
                                    std::size_t count, std::uint64_t seed) {
  std::vector<BrdfSample> samples;
  SampleStream(brdf, set, sampling, seed).Draw(count, &samples);
  return samples;
}

}  // namespace pbnbrdf
