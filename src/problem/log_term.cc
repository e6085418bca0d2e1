#include "problem/log_term.h"

#include <cmath>

#include "kernels/losses.h"

namespace pbnbrdf {

void LogTerm::Grow(const EncodedSamples& samples, std::size_t count) {
  const std::size_t padded = (count + kBatch - 1) / kBatch * kBatch;
  cos_i_.resize(padded);
  targets_.resize(kChannels * padded);
  for (; count_ < count; ++count_) {
    cos_i_[count_] = samples.cos_i(count_);
    double* target = &targets_[count_ / kBatch * kChannels * kBatch + count_ % kBatch];
    for (int c = 0; c < kChannels; ++c) {
      target[c * kBatch] = std::log1p(samples.samples()[count_].value[c] * cos_i_[count_]);
    }
  }
}

void LogTerm::Evaluate(std::size_t b, int, const double* z, TermBatch* to) const {
  // A channel's residual depends on its own output only.
  double slopes[kChannels * kBatch];
  kernels::LogResiduals(z, &targets_[b * kChannels * kBatch], &cos_i_[b * kBatch],
                        to->residuals.data(), slopes);
  for (int c = 0; c < kChannels; ++c) {
    std::copy_n(slopes + c * kBatch, kBatch, &to->slopes[(c * kChannels + c) * kBatch]);
  }
}

void LogTerm::EvaluateResiduals(std::size_t b, int size, const double* z, TermBatch* to) const {
  Evaluate(b, size, z, to);
}

void LogTerm::AddAbsoluteGradient(const float* z, const float* cos_i, const float* f, float scale,
                                  float* gradient) const {
  kernels::AddAbsoluteLogGradient(z, cos_i, f, scale / kChannels, gradient);
}

}  // namespace pbnbrdf
