#include "pbnbrdf/problem/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/pi.h"
#include "base/uniform.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/brdf/scattered.h"
#include "problem/gap_filler.h"

namespace pbnbrdf {
namespace {

constexpr std::size_t kDrawnTogether = 1024;
constexpr std::size_t kDrawsPerKnown = 10000;
constexpr std::size_t kHeldOutOneIn = 8, kFewestToHoldOut = 100;
constexpr std::size_t kFewMeasurements = 3000, kMeasuredToInterpolated = 3;
constexpr std::size_t kExpected =
    9000;  // interpolated ones at least, where it is known what to expect
constexpr double kPlacesPerUnit = 1e6;
// Of the training samples: the part at measured directions, where f isn't measured everywhere alike. More of them
// bring fits nearer there, and farther in between: 0.55 to 0.6 is the middle (experiments/measured.cc).
constexpr double kMeasuredPart = 0.57;

// Uniform on the points of the same grid with even k (training) or odd k (held out).
double UniformOf(SampleSet set, std::mt19937_64& random) {
  const std::uint64_t even = (random() >> 33) << 1;
  return (static_cast<double>(even + (set == SampleSet::kHeldOut)) + 0.5) * 0x1p-32;
}

double DrawThetaH(Sampling sampling, std::mt19937_64& random) {
  const double u = Uniform(random);
  if (sampling == Sampling::kUniform) return 0.5 * kPi * u;
  return 0.5 * kPi * (u < 0.5 ? 2.0 * u : std::pow(2.0 * u - 1.0, 4));
}

// The finalizer of splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t Mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// The same for all measurements at one place, but for rounding.
std::uint64_t PlaceHash(const DirectionPair& pair, bool isotropic) {
  std::uint64_t hash = 0;
  for (double x : MirroredPlace(pair, isotropic)) {
    hash = Mix(hash + static_cast<std::uint64_t>(std::llround(x * kPlacesPerUnit)) + 1);
  }
  return hash;
}

// The measurements of the set: those of the lowest hashes are held out.
std::vector<BrdfSample> PartOf(const std::vector<BrdfSample>& all, SampleSet set, bool isotropic) {
  if (!HoldsOut(all.size())) return all;
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t n = 0; n < all.size(); ++n) {
    order.emplace_back(PlaceHash(all[n].pair, isotropic), n);
  }
  std::sort(order.begin(), order.end());
  const std::size_t held_out = all.size() / kHeldOutOneIn;
  const std::size_t begin = set == SampleSet::kHeldOut ? 0 : held_out;
  const std::size_t end = set == SampleSet::kHeldOut ? held_out : all.size();
  std::vector<BrdfSample> part;
  for (std::size_t k = begin; k < end; ++k) part.push_back(all[order[k].second]);
  return part;
}

// Fisher and Yates; std::shuffle differs between libraries.
void Shuffle(std::vector<BrdfSample>* samples, std::mt19937_64* random) {
  for (std::size_t n = samples->size(); n > 1; --n)
    std::swap((*samples)[n - 1], (*samples)[(*random)() % n]);
}

}  // namespace

bool HoldsOut(std::size_t measurements) { return measurements >= kFewestToHoldOut; }

SampleStream::SampleStream(const Brdf& brdf, SampleSet set, SampleAngles angles, std::uint64_t seed,
                           std::shared_ptr<const Brdf> expected)
    : brdf_(brdf),
      set_(set),
      angles_(std::move(angles)),
      random_(seed),
      expected_(std::move(expected)) {
  Begin();
}

SampleStream SampleStream::WithSeed(std::uint64_t seed) const {
  SampleStream other = *this;
  other.random_.seed(seed);
  other.next_ = 0;
  other.Begin();
  return other;
}

void SampleStream::Begin() {
  const std::vector<BrdfSample> all = brdf_.Measurements();
  if (all.empty()) return;
  if (all.size() == 1) Fail("too little data: a single measurement");
  measured_ = PartOf(all, set_, brdf_.IsIsotropic());
  if (set_ == SampleSet::kTraining) AddInterpolated();
  Shuffle(&measured_, &random_);
}

void SampleStream::AddInterpolated() {
  if (!filler_) {
    filler_ = std::make_shared<GapFiller>(measured_, brdf_.IsIsotropic(), expected_);
  }
  const std::size_t part = measured_.size();
  while (measured_.size() < kFewMeasurements) {
    measured_.insert(measured_.end(), measured_.begin(),
                     measured_.begin() + static_cast<std::ptrdiff_t>(part));
  }
  std::vector<DirectionPair> pairs;
  const std::size_t wanted =
      std::max(measured_.size() / kMeasuredToInterpolated, expected_ ? kExpected : 0);
  while (pairs.size() < wanted) {
    const DirectionPair pair = DrawPair();
    if (pair.AboveHorizon()) pairs.push_back(pair);
  }
  const std::vector<BrdfSample> filled = filler_->At(pairs);
  measured_.insert(measured_.end(), filled.begin(), filled.end());
}

DirectionPair SampleStream::DrawPair() {
  if (angles_.asked && Uniform(random_) >= angles_.floor) {
    std::array<double, 5> u;
    for (double& x : u) x = Uniform(random_);
    u[1] = UniformOf(set_, random_);
    return FromAngles(angles_.asked->Draw(u));
  }
  RusinkiewiczAngles angles;
  angles.theta_h = DrawThetaH(angles_.sampling, random_);
  angles.theta_d = 0.5 * kPi * UniformOf(set_, random_);
  angles.phi_d = 2.0 * kPi * Uniform(random_);
  if (!brdf_.IsIsotropic()) angles.phi_h = 2.0 * kPi * Uniform(random_);
  return FromAngles(angles);
}

// Some of them.
void SampleStream::MoveToMeasured(DirectionPair* pair) {
  const auto measured = brdf_.NearestMeasured(*pair);
  if (measured && Uniform(random_) < kMeasuredPart) *pair = *measured;
}

std::size_t SampleStream::most() const {
  return measured_.empty() ? std::numeric_limits<std::size_t>::max() : measured_.size();
}

void SampleStream::Draw(std::size_t count, std::vector<BrdfSample>* samples) {
  if (measured_.empty()) return DrawAngles(count, samples);
  const std::size_t end = next_ + std::min(count, measured_.size() - next_);
  for (; next_ < end; ++next_) samples->push_back(measured_[next_]);
}

void SampleStream::DrawAngles(std::size_t count, std::vector<BrdfSample>* samples) {
  const std::size_t end = samples->size() + count;
  samples->reserve(end);
  std::vector<DirectionPair> pairs;
  std::vector<Rgb> values(kDrawnTogether);
  for (std::size_t drawn = 0; samples->size() < end; ++drawn) {
    const std::size_t missing = end - samples->size();
    if (drawn >= kDrawsPerKnown * (count - missing + 100)) {
      Fail("too little data: ", count - missing, " of ", drawn, " random angles are known");
    }
    DirectionPair pair = DrawPair();
    if (set_ == SampleSet::kTraining) MoveToMeasured(&pair);
    if (brdf_.IsKnown(pair)) pairs.push_back(pair);
    if (pairs.size() < std::min(kDrawnTogether, missing)) continue;
    brdf_.EvaluateUnclipped(pairs, std::span(values).first(pairs.size()));
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      // The square root leaves interpolated values more of a say: pictures are made of them, too.
      const BrdfSample sample = {pairs[n], values[n], std::sqrt(brdf_.Certainty(pairs[n]))};
      if (IsUsable(sample)) samples->push_back(sample);
    }
    pairs.clear();
  }
}

std::vector<BrdfSample> TrainingMeasurements(const Brdf& brdf) {
  return PartOf(brdf.Measurements(), SampleSet::kTraining, brdf.IsIsotropic());
}

std::vector<BrdfSample> DrawSamples(const Brdf& brdf, SampleSet set, const SampleAngles& angles,
                                    std::size_t count, std::uint64_t seed) {
  std::vector<BrdfSample> samples;
  SampleStream(brdf, set, angles, seed).Draw(count, &samples);
  return samples;
}

std::vector<BrdfSample> HeldOutSamples(const Brdf& material, std::size_t count,
                                       std::uint64_t seed) {
  return DrawSamples(material, SampleSet::kHeldOut, Sampling::kUniform, count, seed);
}

std::vector<BrdfSample> SamplesAt(const Brdf& material, const std::vector<DirectionPair>& pairs) {
  std::vector<Rgb> values(pairs.size());
  material.Evaluate(pairs, values);
  std::vector<BrdfSample> samples;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (material.IsKnown(pairs[n])) samples.push_back({pairs[n], values[n]});
  }
  return samples;
}

std::vector<BrdfSample> MovedToMeasured(const Brdf& material, std::span<const BrdfSample> samples) {
  std::vector<DirectionPair> pairs;
  for (const BrdfSample& sample : samples) {
    const auto measured = material.NearestMeasured(sample.pair);
    if (!measured) return {samples.begin(), samples.end()};
    pairs.push_back(*measured);
  }
  return SamplesAt(material, pairs);
}

}  // namespace pbnbrdf
