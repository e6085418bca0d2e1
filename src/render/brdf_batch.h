// brdf_batch.h: values of one material's BRDF, requested one by one and evaluated together, which is
// much faster for networks.
#pragma once

#include <vector>

#include "pbnbrdf/brdf/brdf.h"
#include "statistics.h"

namespace pbnbrdf {

class BrdfBatch {
 public:
  // Begins a new batch; `stats` counts its values.
  void Begin(ThreadStatistics* stats) {
    stats_ = stats;
    pairs_.clear();
  }

  // Returns the number of the value.
  std::size_t Request(const DirectionPair& pair) {
    stats_->Needed(kKind);
    pairs_.push_back(pair);
    return pairs_.size() - 1;
  }

  // The image does not depend on this value: it is not evaluated, or evaluated and forgotten.
  void RequestUnneeded(SkipReason reason, const DirectionPair& pair) {
    if (stats_->Unneeded(kKind, reason)) pairs_.push_back(pair);
  }

  void Evaluate(const Brdf& brdf) {
    values_.resize(pairs_.size());
    if (pairs_.empty()) return;
    const ScopedTimer timer = stats_->Time(kKind);
    brdf.Evaluate(pairs_, values_);
  }

  const Rgb& value(std::size_t number) const { return values_[number]; }

 private:
  static constexpr auto kKind = &RenderWork::brdf_values;

  ThreadStatistics* stats_ = nullptr;
  std::vector<DirectionPair> pairs_;
  std::vector<Rgb> values_;
};

}  // namespace pbnbrdf
