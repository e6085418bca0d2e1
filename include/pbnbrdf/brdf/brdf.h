// brdf.h: what every source of reflectance answers.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

struct BrdfSample {
  DirectionPair pair;
  Rgb value;            // f in 1/sr; a measured one may be negative, by noise
  double weight = 1.0;  // of its residuals in a fit, in (0, 1]; 1: as well known as any
};

// Whether the terms of a fit exist there: its values are finite, and log(1 + f cos theta_i) is defined
// (f cos theta_i > -0.999). Noise makes measurements negative; to leave those out would make dark
// materials brighter.
bool IsUsable(const BrdfSample& sample);

// A bidirectional reflectance distribution function f(wi, wo): linear RGB in 1/sr, finite, not
// multiplied by a cosine. Batches are the unit of work. All members may be called from several
// threads at once.
class Brdf {
 public:
  virtual ~Brdf() = default;

  // values[n] = f(pairs[n]), from 0 to kLargestValue; 0 where either direction isn't above the horizon.
  // Sizes must agree.
  void Evaluate(std::span<const DirectionPair> pairs, std::span<Rgb> values) const;

  // As Evaluate, but not clipped: values below the horizon, where a network goes on (eqs. 8 and 9 of the
  // paper are taken over the whole domain of angles), and negative measurements are what the source says.
  virtual void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                 std::span<Rgb> values) const = 0;

  // Whether f is known at the pair: above the horizon and, for a table, in a bin with data.
  virtual bool IsKnown(const DirectionPair& pair) const { return pair.AboveHorizon(); }

  // Whether f stays the same when wi and wo turn together about the normal.
  virtual bool IsIsotropic() const { return true; }

  // The measurements themselves, all of them above the horizon, where a source is a list of them
  // instead of a model or a grid: what is fitted, while f in between is interpolated. Else empty.
  virtual std::vector<BrdfSample> Measurements() const { return {}; }

  // What a fit aims at, where that differs from this; else null.
  //
  // kLikeliest: what f is most likely to be where the format interpolates between measurements.
  // kAsStored:  what the format says, all of it equally certain, and as far towards the horizon as it goes.
  enum class Estimate { kLikeliest, kAsStored };
  virtual std::unique_ptr<Brdf> BestEstimate(Estimate) const { return nullptr; }

  // How well f is known at the pair, in (0, 1]: 1 where it was measured, less where it is interpolated.
  virtual double Certainty(const DirectionPair&) const { return 1.0; }

  // The pair moved to the nearest directions at which f was measured; none where f is known equally
  // well everywhere.
  virtual std::optional<DirectionPair> NearestMeasured(const DirectionPair&) const { return {}; }

  // The incident angles theta_i (radians, ascending) each of which f was measured at, towards many
  // directions. None of formulas, of networks, and of tables over the half vector.
  virtual std::vector<double> IncidentAngles() const { return {}; }

  // As if IncidentAngles()[index], neither the first nor the last one, had not been measured; else null.
  virtual std::unique_ptr<Brdf> WithoutIncidentAngle(std::size_t) const { return nullptr; }

  // Whether f was measured at directions of its own, which aren't the rows of a MERL table.
  virtual bool HasOwnDirections() const { return false; }

  // Whether f(wi, wo) = f(wo, wi) always, but for rounding.
  virtual bool IsReciprocal() const { return false; }

  // 3, or 1 where the three channels are one and the same.
  virtual int NumChannels() const { return 3; }

  // The same in single precision, where that is several times faster; else null.
  virtual std::unique_ptr<Brdf> SinglePrecision() const { return nullptr; }

  // One line: the model and its main parameters.
  virtual std::string Description() const = 0;

  // Peaks beyond this (1/sr) are cut: narrower lobes than any measurement resolves.
  static constexpr double kLargestValue = 1e12;
};

// A Brdf with the same formula for each pair; implementations write one pair's value.
class PointwiseBrdf : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs, std::span<Rgb> values) const final;

 protected:
  // Called for pairs above the horizon only.
  virtual Rgb Value(const DirectionPair& pair) const = 0;
};

}  // namespace pbnbrdf
