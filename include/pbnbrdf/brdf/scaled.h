// scaled.h: a source of reflectance times a factor, and the factor that gives it a wanted albedo.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// f = factor * f of the source, in all three channels; known where the source is.
class ScaledBrdf final : public Brdf {
 public:
  // factor: finite, >= 0. Throws Error otherwise.
  ScaledBrdf(std::unique_ptr<Brdf> source, double factor);

  // Cut to kLargestValue, as any source.
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  bool IsKnown(const DirectionPair& pair) const override { return source_->IsKnown(pair); }
  bool IsIsotropic() const override { return source_->IsIsotropic(); }
  std::vector<BrdfSample> Measurements() const override;
  std::unique_ptr<Brdf> BestEstimate(Estimate estimate) const override;
  double Certainty(const DirectionPair& pair) const override { return source_->Certainty(pair); }
  std::optional<DirectionPair> NearestMeasured(const DirectionPair& pair) const override {
    return source_->NearestMeasured(pair);
  }
  bool HasOwnDirections() const override { return source_->HasOwnDirections(); }
  bool IsReciprocal() const override { return source_->IsReciprocal(); }
  int NumChannels() const override { return source_->NumChannels(); }
  std::string Description() const override;

  double factor() const { return factor_; }

 private:
  void Scale(Rgb* value) const;

  std::unique_ptr<Brdf> source_;
  double factor_;
};

// The largest directional albedo (albedo.h) over the channels and incident directions of up to 85
// degrees, within 1e-4: nearer to the horizon tables have no data. Throws Error if an albedo isn't finite.
double LargestAlbedo(const Brdf& brdf);

// The source times the factor that makes its LargestAlbedo `albedo`. Measured scales are uncertain,
// and a material that reflects next to everything is what tests the conservation of energy. Throws
// Error if albedo isn't finite and > 0, or no factor achieves it.
std::unique_ptr<ScaledBrdf> ScaleToAlbedo(std::unique_ptr<Brdf> source, double albedo);

}  // namespace pbnbrdf
