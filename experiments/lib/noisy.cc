#include "noisy.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "base/uniform.h"

namespace pbnbrdf {
namespace {

const double kLeastIncidentCosine = std::cos(80.0 * std::numbers::pi / 180.0);

class Deviates {
 public:
  explicit Deviates(std::uint64_t seed) : random_(seed) {}

  // Box and Muller; std::normal_distribution differs between libraries.
  double Normal() {
    const double radius = std::sqrt(-2.0 * std::log(Uniform(random_)));
    return radius * std::cos(2.0 * std::numbers::pi * Uniform(random_));
  }

  double Noisy(double f, const Noise& noise) {
    const double a = Normal();
    return f * (1.0 + noise.multiplicative * a) + noise.additive * Normal();
  }

  // With a cosine of at least `least`.
  Vec3 Direction(double least) {
    const double theta = std::acos(least + (1.0 - least) * Uniform(random_));
    return FromSpherical(theta, 2.0 * std::numbers::pi * Uniform(random_));
  }

 private:
  std::mt19937_64 random_;
};

// Sum of the fit's values over that of the samples', over their darker half in a channel.
double DarkHalfRatio(std::span<const BrdfSample> samples, std::span<const Rgb> values,
                     std::size_t channel) {
  std::vector<std::size_t> order(samples.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return samples[a].value[channel] < samples[b].value[channel];
  });
  double truth = 0.0, found = 0.0;
  for (std::size_t k = 0; k < order.size() / 2; ++k) {
    truth += samples[order[k]].value[channel];
    found += values[order[k]][channel];
  }
  return found / truth;
}

}  // namespace

MerlBrdf NoisyTable(const Brdf& clean, const Noise& noise, std::uint64_t seed) {
  Deviates deviates(seed);
  return MerlBrdf::Tabulate(clean).Changed([&](double f) { return deviates.Noisy(f, noise); });
}

ScatteredBrdf NoisyMeasurements(const Brdf& clean, std::size_t count, const Noise& noise,
                                std::uint64_t seed) {
  Deviates deviates(seed);
  std::vector<DirectionPair> pairs;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 wi = deviates.Direction(kLeastIncidentCosine);
    pairs.push_back({wi, deviates.Direction(0.0)});
  }
  std::vector<Rgb> values(count);
  clean.Evaluate(pairs, values);
  ScatteredData data;
  data.kind = "noisy measurements";
  data.isotropic = clean.IsIsotropic();
  for (std::size_t n = 0; n < count; ++n) {
    for (double& f : values[n]) f = deviates.Noisy(f, noise);
    data.samples.push_back({pairs[n], values[n]});
  }
  return ScatteredBrdf(std::move(data));
}

double DarkHalfBias(std::span<const BrdfSample> samples, const Brdf& fit) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : samples) pairs.push_back(sample.pair);
  std::vector<Rgb> values(pairs.size());
  fit.Evaluate(pairs, values);
  double worst = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double bias = DarkHalfRatio(samples, values, c) - 1.0;
    if (std::abs(bias) > std::abs(worst)) worst = bias;
  }
  return worst;
}

}  // namespace pbnbrdf
