#include "measured_samples.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "base/uniform.h"
#include "brdf/point_tree.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"

namespace pbnbrdf {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kSamePlace = 1e-3;  // in the coordinates of scattered.h

PointTree TreeOf(std::span<const BrdfSample> samples, bool isotropic) {
  std::vector<PointTree::Point> places;
  for (const BrdfSample& sample : samples) places.push_back(MirroredPlace(sample.pair, isotropic));
  return PointTree(std::move(places));
}

class NearestMeasurement final : public PointwiseBrdf {
 public:
  explicit NearestMeasurement(const Brdf& material)
      : samples_(material.Measurements()),
        isotropic_(material.IsIsotropic()),
        channels_(material.NumChannels()),
        tree_(TreeOf(samples_, isotropic_)) {}

  bool IsIsotropic() const override { return isotropic_; }
  bool IsReciprocal() const override { return true; }
  int NumChannels() const override { return channels_; }
  std::string Description() const override { return "the nearest measurement"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    return samples_[tree_.Nearest(MirroredPlace(pair, isotropic_), 1).front().index].value;
  }

 private:
  std::vector<BrdfSample> samples_;
  bool isotropic_;
  int channels_;
  PointTree tree_;
};

// Another Brdf's values, without its measurements and what it says of itself.
class ValuesOf final : public Brdf {
 public:
  explicit ValuesOf(std::shared_ptr<const Brdf> source) : source_(std::move(source)) {}

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    source_->EvaluateUnclipped(pairs, values);
  }
  bool IsKnown(const DirectionPair& pair) const override { return source_->IsKnown(pair); }
  bool IsIsotropic() const override { return source_->IsIsotropic(); }
  bool IsReciprocal() const override { return source_->IsReciprocal(); }
  int NumChannels() const override { return source_->NumChannels(); }
  std::string Description() const override { return source_->Description(); }

 private:
  std::shared_ptr<const Brdf> source_;
};

double RepetitionFloor(std::span<const BrdfSample> samples, bool isotropic) {
  const PointTree tree = TreeOf(samples, isotropic);
  double sum = 0.0;
  std::size_t count = 0;
  for (const BrdfSample& sample : samples) {
    const auto near = tree.Nearest(MirroredPlace(sample.pair, isotropic), 2);
    if (near.size() < 2 || near.back().squared_distance > kSamePlace * kSamePlace) continue;
    const double cos_i = sample.pair.wi.z;
    const auto log = [&](std::size_t k, int c) {
      return std::log1p(samples[near[k].index].value[c] * cos_i);
    };
    for (int c = 0; c < 3; ++c) sum += std::abs(log(0, c) - log(1, c)), ++count;
  }
  return count > 0 ? 0.5 * sum / static_cast<double>(count)
                   : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<BrdfSample> SamplesAtAngle(const Brdf& material, double theta_i, std::size_t count) {
  std::vector<BrdfSample> measured = material.Measurements();
  if (!measured.empty()) {
    std::erase_if(measured, [&](const BrdfSample& sample) {
      return std::abs(Theta(sample.pair.wi) - theta_i) > ScatteredBrdf::kSameIncidence;
    });
    return measured;
  }
  std::mt19937_64 random(kSeed);
  const Vec3 wi = FromSpherical(theta_i, 0.0);
  std::vector<DirectionPair> pairs;
  while (pairs.size() < count) {
    const double theta_h = 0.5 * std::numbers::pi * Uniform(random);
    const Vec3 h = FromSpherical(theta_h, 2.0 * std::numbers::pi * Uniform(random));
    const DirectionPair pair = {wi, 2.0 * Dot(wi, h) * h - wi};
    if (material.IsKnown(pair)) pairs.push_back(pair);
  }
  return SamplesAt(material, pairs);
}

std::vector<BrdfSample> SamplesAtMeasured(const Brdf& material, std::size_t count) {
  const std::vector<BrdfSample> measured = material.Measurements();
  if (!measured.empty()) return HeldOutSamples(material, measured.size(), kSeed);
  std::vector<BrdfSample> all;
  for (double theta_i : material.IncidentAngles()) {
    if (!material.IsKnown({FromSpherical(theta_i, 0.0), {0.0, 0.0, 1.0}})) continue;
    const std::vector<BrdfSample> samples = SamplesAtAngle(material, theta_i, count);
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all.empty() ? HeldOutSamples(material, count, kSeed) : all;
}

double MeasuredFloor(const Brdf& material, std::span<const BrdfSample> samples) {
  const std::vector<BrdfSample> measured = material.Measurements();
  return measured.empty() ? ReciprocalFloor(samples, material)
                          : RepetitionFloor(measured, material.IsIsotropic());
}

std::unique_ptr<Brdf> PlainInterpolation(const Brdf& material) {
  if (!material.Measurements().empty()) return std::make_unique<NearestMeasurement>(material);
  return std::make_unique<ValuesOf>(
      std::shared_ptr<const Brdf>(std::shared_ptr<void>(), &material));
}

std::unique_ptr<Brdf> AsInterpolated(const Brdf& material) {
  if (material.Measurements().empty()) return PlainInterpolation(material);
  ScatteredData data;
  data.kind = material.Description();
  data.channels = material.NumChannels();
  data.isotropic = material.IsIsotropic();
  data.samples = TrainingMeasurements(material);
  return std::make_unique<ValuesOf>(std::make_shared<ScatteredBrdf>(std::move(data)));
}

}  // namespace pbnbrdf
