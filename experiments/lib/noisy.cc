#include "noisy.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr double kScales[] = {1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0};  // merl.h
constexpr std::size_t kHeaderBytes = 12;
const double kLeastIncidentCosine = std::cos(80.0 * std::numbers::pi / 180.0);

class Deviates {
 public:
  explicit Deviates(std::uint64_t seed) : random_(seed) {}

  // In (0, 1).
  double Uniform() { return (static_cast<double>(random_() >> 32) + 0.5) * 0x1p-32; }

  // Box and Muller; std::normal_distribution differs between libraries.
  double Normal() {
    const double radius = std::sqrt(-2.0 * std::log(Uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * Uniform());
  }

  double Noisy(double f, const Noise& noise) {
    const double a = Normal();
    return f * (1.0 + noise.multiplicative * a) + noise.additive * Normal();
  }

  // With a cosine of at least `least`.
  Vec3 Direction(double least) {
    const double theta = std::acos(least + (1.0 - least) * Uniform());
    return FromSpherical(theta, 2.0 * std::numbers::pi * Uniform());
  }

 private:
  std::mt19937_64 random_;
};

bool IsValid(const MerlBrdf& table, std::size_t bin) { return table.Stored(0, bin) >= 0.0; }

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

MerlBrdf NoisyTable(const Brdf& clean, const Noise& noise, std::uint64_t seed,
                    const std::string& path) {
  const MerlBrdf table = MerlBrdf::Tabulate(clean);
  std::string bytes = table.FileBytes();
  Deviates deviates(seed);
  for (std::size_t bin = 0; bin < MerlBrdf::kBins; ++bin) {
    if (!IsValid(table, bin)) continue;
    for (int c = 0; c < 3; ++c) {
      const double f = table.Stored(c, bin) * kScales[c];
      const double stored = deviates.Noisy(f, noise) / kScales[c];
      const std::size_t place = static_cast<std::size_t>(c) * MerlBrdf::kBins + bin;
      std::memcpy(&bytes[kHeaderBytes + place * sizeof(double)], &stored, sizeof(double));
    }
  }
  WriteFile(path, bytes);
  MerlBrdf noisy = MerlBrdf::Read(path);
  std::filesystem::remove(path);
  return noisy;
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
