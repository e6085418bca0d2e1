// reciprocal.h: the nearest reciprocal material to one that isn't.
#pragma once

#include <memory>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

// The mean of f(wi, wo) and f(wo, wi), each weighted by its certainty; only one of them where the other
// isn't known. Measurements contradict each other there, and so do tables whose interpolation depends on
// wi. With equal weights no reciprocal function has a smaller mean square distance to f.
class ReciprocalBrdf final : public Brdf {
 public:
  explicit ReciprocalBrdf(std::shared_ptr<const Brdf> source);

  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override;
  bool IsKnown(const DirectionPair& pair) const override;
  bool IsIsotropic() const override { return source_->IsIsotropic(); }
  std::vector<BrdfSample> Measurements() const override { return source_->Measurements(); }
  std::unique_ptr<Brdf> BestEstimate(Estimate estimate) const override;
  double Certainty(const DirectionPair& pair) const override;
  std::optional<DirectionPair> NearestMeasured(const DirectionPair& pair) const override {
    return source_->NearestMeasured(pair);
  }
  bool HasOwnDirections() const override { return source_->HasOwnDirections(); }
  bool IsReciprocal() const override { return true; }
  int NumChannels() const override { return source_->NumChannels(); }
  std::string Description() const override;

 private:
  double Weight(const DirectionPair& pair) const;

  std::shared_ptr<const Brdf> source_;
};

}  // namespace pbnbrdf
