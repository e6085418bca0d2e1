#include "problem/minibatch_gradient.h"

#include <algorithm>
#include <numbers>

#include "kernels/kernels.h"
#include "kernels/losses.h"
#include "kernels/passes.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;

}  // namespace

MinibatchGradient::MinibatchGradient(const FitProblem& problem)
    : shape_(problem.Shape()),
      terms_(MakeSampleTerms(problem.terms)),
      energy_weight_(static_cast<float>(problem.terms.EnergyWeight() * 2.0 * std::numbers::pi)),
      mlp_(shape_, 1) {}

void MinibatchGradient::Evaluate(const float* weights, const Minibatches& minibatches,
                                 std::size_t minibatch, float* gradient) {
  std::fill(gradient, gradient + shape_.num_weights(), 0.0f);
  const float scale = 1.0f / static_cast<float>(minibatches.batch);
  for (std::size_t b = 0; b < minibatches.BlocksPerStep(); ++b) {
    AddBlock(weights, minibatches.SampleBlock(minibatch, b), scale, gradient);
  }
  const auto albedos = minibatches.AlbedosOf(minibatch);
  const float albedo_scale =
      energy_weight_ / static_cast<float>(kChannels * std::max<std::size_t>(albedos.size(), 1));
  for (const Minibatches::Albedo& albedo : albedos) {
    AddAlbedo(weights, minibatches, albedo, albedo_scale, gradient);
  }
}

void MinibatchGradient::AddBlock(const float* weights, const float* block, float scale,
                                 float* gradient) {
  mlp_.Forward(weights, block);
  float* to = mlp_.output_gradient(0);
  std::fill(to, to + kChannels * kBatch, 0.0f);
  // A place without a sample has cos_i = 0, thus no gradient.
  for (const WeightedSampleTerm& term : terms_) {
    term.term->AddAbsoluteGradient(mlp_.output(), block + Minibatches::kCos * kBatch,
                                   block + Minibatches::kValue * kBatch,
                                   scale * static_cast<float>(term.weight), to);
  }
  const float* sample_weights = block + Minibatches::kSampleWeight * kBatch;
  for (int i = 0; i < kChannels * kBatch; ++i) to[i] *= sample_weights[i % kBatch];
  mlp_.Backward(weights);
  mlp_.AddWeightGradient(0, gradient);
}

// scale: of the excess over 1 of a channel's albedo.
void MinibatchGradient::AddAlbedo(const float* weights, const Minibatches& minibatches,
                                  const Minibatches::Albedo& albedo, float scale, float* gradient) {
  float values[kChannels] = {};
  for (std::size_t b = 0; b < albedo.blocks; ++b) {
    const float* block = minibatches.NodeBlock(albedo.first_block + b);
    mlp_.Forward(weights, block);
    kernels::AddReflectanceSums(mlp_.output(), block + Minibatches::kWeight * kBatch, values);
  }
  float scales[kChannels];
  for (int c = 0; c < kChannels; ++c) scales[c] = values[c] > 1.0f ? scale : 0.0f;
  if (*std::max_element(values, values + kChannels) <= 1.0f) return;
  for (std::size_t b = 0; b < albedo.blocks; ++b) {
    AddNodes(weights, minibatches.NodeBlock(albedo.first_block + b), scales, gradient);
  }
}

// The gradient of sum_c scales[c] * (the nodes' part of channel c's albedo).
void MinibatchGradient::AddNodes(const float* weights, const float* block, const float* scales,
                                 float* gradient) {
  mlp_.Forward(weights, block);
  const float* node_weights = block + Minibatches::kWeight * kBatch;
  const float* z = mlp_.output();
  float* to = mlp_.output_gradient(0);
  std::copy_n(z, kChannels * kBatch, to);
  kernels::Exp(to, kChannels * kBatch);  // the slope of expm1
  for (int c = 0; c < kChannels; ++c) {
    for (int n = 0; n < kBatch; ++n) {
      const int at = c * kBatch + n;
      to[at] *= z[at] > 0.0f ? scales[c] * node_weights[n] : 0.0f;
    }
  }
  mlp_.Backward(weights);
  mlp_.AddWeightGradient(0, gradient);
}

}  // namespace pbnbrdf
