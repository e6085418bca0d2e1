// encoded_samples.h: samples of a material as the passes of a network and the terms of the cost want
// them: each is encoded once, whatever uses it later and in whatever precision.
#pragma once

#include <span>
#include <vector>

#include "network/encoded_batches.h"
#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf {

class EncodedSamples {
 public:
  explicit EncodedSamples(Encoding encoding) : encoding_(encoding) {}
  EncodedSamples(Encoding encoding, std::span<const BrdfSample> samples) : encoding_(encoding) {
    Add(samples);
  }

  void Add(std::span<const BrdfSample> samples) {
    inputs_.Reserve(size() + samples.size());
    for (const BrdfSample& sample : samples) {
      inputs_.Add(Encode(encoding_, sample.pair));
      cos_i_.push_back(CosI(sample.pair));
      samples_.push_back(sample);
    }
  }

  Encoding encoding() const { return encoding_; }
  std::size_t size() const { return samples_.size(); }
  std::span<const BrdfSample> samples() const { return samples_; }
  std::span<const BrdfSample> first(std::size_t count) const {
    return samples().first(std::min(count, size()));
  }
  // Of the residuals of sample n.
  double weight(std::size_t n) const { return samples_[n].weight; }
  double cos_i(std::size_t n) const { return cos_i_[n]; }
  const EncodedBatches<double>& inputs() const { return inputs_; }

 private:
  Encoding encoding_;
  std::vector<BrdfSample> samples_;
  std::vector<double> cos_i_;  // clamped to [0, 1]
  EncodedBatches<double> inputs_;
};

}  // namespace pbnbrdf
