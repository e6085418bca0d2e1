// minibatch_gradient.h: the gradient of the papers' own loss on a few samples, for stochastic
// solvers.
//
//   mean over samples of  log_weight * mean_c |r_log,c|  +  chromaticity_weight * |r_chromaticity|,
//
// eqs. 6 and 7 with f^ = max(0, expm1(z)), clamped as NBRDF trains it: no gradient where f^ = 0.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pbnbrdf/base/aligned_vector.h"
#include "pbnbrdf/brdf/sampling.h"
#include "pbnbrdf/network/batched_mlp.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf {

// In single precision. The problem's robust loss and energy term play no part.
class MinibatchGradient {
 public:
  MinibatchGradient(const FitProblem& problem, std::span<const BrdfSample> samples);
  ~MinibatchGradient();

  std::size_t num_samples() const { return num_samples_; }

  // gradient: P numbers, the mean over the samples of those indices; the same for any number of
  // threads.
  void Evaluate(const float* weights, std::span<const std::uint32_t> indices, float* gradient);

 private:
  struct Block;

  void EvaluateBlock(const float* weights, std::span<const std::uint32_t> indices, float scale,
                     Block* block) const;

  NetworkShape shape_;
  float log_weight_, chromaticity_weight_;
  std::size_t num_samples_;
  AlignedVector<float> samples_;                // sample after sample: encoded pair, cos_i, f
  std::vector<std::unique_ptr<Block>> blocks_;  // a kernels::kBatch of the minibatch each
};

}  // namespace pbnbrdf
