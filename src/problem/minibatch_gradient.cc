#include "pbnbrdf/problem/minibatch_gradient.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {
namespace {

constexpr int kBatch = kernels::kBatch;
constexpr int kChannels = NetworkShape::kChannels;
constexpr int kCos = kEncodedSize, kValue = kCos + 1, kSampleSize = kValue + kChannels;

float Sign(float x) { return x > 0.0f ? 1.0f : x < 0.0f ? -1.0f : 0.0f; }

}  // namespace

struct MinibatchGradient::Block {
  explicit Block(const NetworkShape& shape)
      : mlp(shape, 1), samples(kSampleSize * kBatch), gradient(shape.num_weights()) {}
  BatchedMlp<float> mlp;
  AlignedVector<float> samples;  // by feature
  AlignedVector<float> gradient;
};

MinibatchGradient::MinibatchGradient(const FitProblem& problem, std::span<const BrdfSample> samples)
    : shape_(problem.Shape()),
      log_weight_(static_cast<float>(problem.log_weight)),
      chromaticity_weight_(static_cast<float>(problem.chromaticity_weight)),
      num_samples_(samples.size()) {
  samples_.reserve(num_samples_ * kSampleSize);
  for (const BrdfSample& s : samples) {
    for (double x : Encode(shape_.encoding(), s.pair)) samples_.push_back(static_cast<float>(x));
    samples_.push_back(static_cast<float>(CosI(s.pair)));
    for (double f : s.value) samples_.push_back(static_cast<float>(f));
  }
}

MinibatchGradient::~MinibatchGradient() = default;

void MinibatchGradient::Evaluate(const float* weights, std::span<const std::uint32_t> indices,
                                 float* gradient) {
  const std::size_t blocks = (indices.size() + kBatch - 1) / kBatch;
  while (blocks_.size() < blocks) blocks_.push_back(std::make_unique<Block>(shape_));
  const float scale = 1.0f / static_cast<float>(indices.size());
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    const std::size_t first = b * kBatch;
    EvaluateBlock(weights,
                  indices.subspan(first, std::min<std::size_t>(kBatch, indices.size() - first)),
                  scale, blocks_[b].get());
  });
  std::fill(gradient, gradient + shape_.num_weights(), 0.0f);
  for (std::size_t b = 0; b < blocks; ++b) {
    for (int i = 0; i < shape_.num_weights(); ++i) gradient[i] += blocks_[b]->gradient[i];
  }
}

void MinibatchGradient::EvaluateBlock(const float* weights, std::span<const std::uint32_t> indices,
                                      float scale, Block* block) const {
  float* samples = block->samples.data();
  for (std::size_t n = 0; n < indices.size(); ++n) {
    const float* from = samples_.data() + std::size_t{indices[n]} * kSampleSize;
    for (int i = 0; i < kSampleSize; ++i) samples[i * kBatch + n] = from[i];
  }
  block->mlp.Forward(weights, samples);
  // The outputs' gradient starts as exp(z).
  float* gradient = block->mlp.output_gradient(0);
  std::copy_n(block->mlp.output(), kChannels * kBatch, gradient);
  kernels::Exp(gradient, kChannels * kBatch);
  for (int n = 0; n < kBatch; ++n) {
    // A place without a sample keeps a gradient of 0.
    const float weight = static_cast<std::size_t>(n) < indices.size() ? scale : 0.0f;
    const float cos_i = samples[kCos * kBatch + n];
    float norm = 0.0f, norm_fit = 0.0f, fit[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      const float f = samples[(kValue + c) * kBatch + n];
      fit[c] = std::max(gradient[c * kBatch + n] - 1.0f, 0.0f);
      norm += f * f;
      norm_fit += fit[c] * fit[c];
    }
    const float chroma = 2.0f * chromaticity_weight_ * Sign(norm_fit - norm) * cos_i * cos_i /
                         (1.0f + cos_i * cos_i * norm_fit);
    for (int c = 0; c < kChannels; ++c) {
      const float f = samples[(kValue + c) * kBatch + n];
      // |log1p(a) - log1p(b)| falls and rises with a as |a - b| does: no logarithm is needed.
      const float log =
          log_weight_ / kChannels * Sign(fit[c] - f) * cos_i / (1.0f + cos_i * fit[c]);
      const float slope = fit[c] > 0.0f ? gradient[c * kBatch + n] : 0.0f;
      gradient[c * kBatch + n] = weight * slope * (log + chroma * fit[c]);
    }
  }
  block->mlp.Backward(weights);
  std::fill(block->gradient.begin(), block->gradient.end(), 0.0f);
  block->mlp.AddWeightGradient(0, block->gradient.data());
}

}  // namespace pbnbrdf
