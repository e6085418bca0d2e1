// minibatch_gradient.h: the gradient of the papers' own loss (Loss::kAbsolute) on a minibatch.
#pragma once

#include <vector>

#include "base/aligned_vector.h"
#include "network/batched_mlp.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "problem/minibatches.h"
#include "problem/terms.h"

namespace pbnbrdf {

// In single precision, on one thread: a minibatch is too little work to share.
class MinibatchGradient {
 public:
  explicit MinibatchGradient(const FitProblem& problem);

  // gradient: P numbers, the means over the samples and over the albedos of that minibatch. An
  // albedo is clamped below at 0 for each node, as the network is when evaluated (eq. 5).
  void Evaluate(const float* weights, const Minibatches& minibatches, std::size_t minibatch,
                float* gradient);

 private:
  static constexpr int kChannels = NetworkShape::kChannels;

  void AddBlock(const float* weights, const float* block, float scale, float* gradient);
  void AddAlbedo(const float* weights, const Minibatches& minibatches,
                 const Minibatches::Albedo& albedo, float scale, float* gradient);
  void AddNodes(const float* weights, const float* block, const float* scales, float* gradient);

  NetworkShape shape_;
  std::vector<WeightedSampleTerm> terms_;
  float energy_weight_;
  BatchedMlp<float> mlp_;
};

}  // namespace pbnbrdf
