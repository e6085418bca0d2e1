// sampling.h: values of a Brdf at random Rusinkiewicz angles.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "pbnbrdf/base/names.h"
#include "pbnbrdf/brdf/angle_distribution.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

class GapFiller;

// How theta_h is drawn; theta_d in [0, pi/2) and phi_d in [0, 2 pi) are uniform. phi_h = 0 of an
// isotropic Brdf, else uniform in [0, 2 pi).
enum class Sampling {
  kUniform,    // theta_h uniform in [0, pi/2), as NBRDF does
  kHighlight,  // half of the samples so, half at theta_h = (pi/2) u^4, dense near the mirror
};

inline constexpr NameTable<Sampling, 2> kSamplings = {
    {{"uniform", Sampling::kUniform}, {"highlight", Sampling::kHighlight}}};

// Where samples are: as `sampling` says or, all but a part of `floor`, where a scene asks.
struct SampleAngles {
  SampleAngles(Sampling all) : sampling(all) {}  // NOLINT: the usual case

  Sampling sampling;
  std::shared_ptr<const AngleDistribution> asked = nullptr;
  double floor = 1.0;  // in [0, 1]
};

// The two sets draw theta_d from disjoint grids: they have no sample in common, whatever the seeds.
enum class SampleSet { kTraining, kHeldOut };

// Whether some of so many measurements are held out of a fit: each counts where there are few.
bool HoldsOut(std::size_t measurements);

// Samples at which a Brdf is known, one after the other: the same arguments give the same ones,
// however many at a time. Angles that are asked for belong to materials of their kind, isotropic or
// not, and matter only to a Brdf that isn't a list of measurements.
//
// Of a Brdf that is a list of measurements these are the samples, in a random order. One in 8 is held
// out, whatever the seed, together with those at the same place (scattered.h): repeated, reciprocal
// and, if isotropic, mirrored ones. To three training samples comes a fourth at angles drawn as those
// of any other Brdf, with the value that they and a model suggest there (gap_filler.h):
// what is measured along a few lines only leaves wide gaps, in which networks that nothing holds grow by
// orders of magnitude. Where there are fewer than 3000, all are repeated until they aren't, so that gaps
// are filled, too, without counting more than measurements. Where it is known what to expect, there
// are 9000 interpolated ones or more.
class SampleStream {
 public:
  // brdf must outlive this. expected: the model for what isn't measured; null: an analytic one that is fitted to
  // the measurements.
  SampleStream(const Brdf& brdf, SampleSet set, SampleAngles angles, std::uint64_t seed,
               std::shared_ptr<const Brdf> expected = nullptr);

  // As if made with another seed, without what doesn't depend on it being done again.
  SampleStream WithSeed(std::uint64_t seed) const;

  // Appends the next `count` samples, fewer if there are no more. Throws Error if next to no angles
  // are known (fewer than 1 in 10,000).
  void Draw(std::size_t count, std::vector<BrdfSample>* samples);

  // How many samples there are in all; the largest number there is where they never end.
  std::size_t most() const;

 private:
  void Begin();
  void AddInterpolated();
  DirectionPair DrawPair();
  void MoveToMeasured(DirectionPair* pair);
  void DrawAngles(std::size_t count, std::vector<BrdfSample>* samples);

  const Brdf& brdf_;
  SampleSet set_;
  SampleAngles angles_;
  std::mt19937_64 random_;
  std::shared_ptr<const Brdf> expected_;
  std::shared_ptr<const GapFiller> filler_;  // of measured_; null where none is needed
  std::vector<BrdfSample> measured_;         // of the set, and interpolated ones, shuffled
  std::size_t next_ = 0;                     // of them
};

// The measurements of SampleSet::kTraining, in an order that hashes give; none if the Brdf isn't a list of them.
std::vector<BrdfSample> TrainingMeasurements(const Brdf& brdf);

// The first `count` samples of a SampleStream, or all if there are fewer.
std::vector<BrdfSample> DrawSamples(const Brdf& brdf, SampleSet set, const SampleAngles& angles,
                                    std::size_t count, std::uint64_t seed);

// What a fit to the material is measured on: DrawSamples of SampleSet::kHeldOut at uniform angles.
std::vector<BrdfSample> HeldOutSamples(const Brdf& material, std::size_t count, std::uint64_t seed);

// The values at the pairs at which the material is known.
std::vector<BrdfSample> SamplesAt(const Brdf& material, const std::vector<DirectionPair>& pairs);

// The samples, each moved to the nearest directions at which the material was measured; as they are where
// it is known equally well everywhere.
std::vector<BrdfSample> MovedToMeasured(const Brdf& material, std::span<const BrdfSample> samples);

}  // namespace pbnbrdf
