// minibatches.h: random minibatches of the training samples, for stochastic solvers, with random
// quadratures for the energy term (eq. 5), laid out for the kernels.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "pbnbrdf/network/encoding.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "problem/encoded_samples.h"

namespace pbnbrdf {

// A few minibatches, to be evaluated one after the other.
struct Minibatches {
  // Rows of a block of kernels::kBatch samples, by feature: the encoded pair, cos_i, f, the weight of
  // the sample, their mean being 1. Zeros stand behind the last sample of a minibatch.
  static constexpr int kCos = kEncodedSize, kValue = kCos + 1, kSampleWeight = kValue + 3;
  static constexpr int kRows = kSampleWeight + 1;
  // Rows of a block of kernels::kBatch nodes: the encoded pair, the weight. Zeros likewise.
  static constexpr int kWeight = kEncodedSize, kNodeRows = kWeight + 1;

  // The directional albedo of an incident angle is the sum of weight * f over the nodes of its
  // blocks.
  struct Albedo {
    std::size_t first_block, blocks;
  };

  std::size_t count = 0;             // of minibatches
  std::size_t batch = 0;             // samples of each
  bool ends_epoch = false;           // whether the last one ends an epoch
  AlignedVector<float> samples;      // blocks, minibatch after minibatch
  AlignedVector<float> nodes;        // blocks
  std::vector<Albedo> albedos;       // set after set
  std::size_t albedos_per_step = 0;  // in a set; 0: no energy term

  std::size_t BlocksPerStep() const { return (batch + kernels::kBatch - 1) / kernels::kBatch; }

  const float* SampleBlock(std::size_t minibatch, std::size_t block) const {
    return samples.data() +
           (minibatch * BlocksPerStep() + block) * std::size_t{kRows} * kernels::kBatch;
  }
  const float* NodeBlock(std::size_t block) const {
    return nodes.data() + block * std::size_t{kNodeRows} * kernels::kBatch;
  }

  // The albedos of a minibatch; the sets take turns.
  std::span<const Albedo> AlbedosOf(std::size_t minibatch) const {
    if (albedos_per_step == 0) return {};
    const std::size_t set = minibatch % (albedos.size() / albedos_per_step);
    return std::span(albedos).subspan(set * albedos_per_step, albedos_per_step);
  }
};

// Goes through all samples in random order (SamplingOptions::seed), epoch after epoch.
class MinibatchStream {
 public:
  // batch: samples of a minibatch, 1 to as many as there are; those that are left over at the end
  // of an epoch are left out. energy_angles: incident angles of a minibatch, >= 1.
  MinibatchStream(const FitProblem& problem, const EncodedSamples& samples, std::size_t batch,
                  int energy_angles);

  // The next few minibatches, of one epoch all of them.
  void Draw(Minibatches* to);

 private:
  std::span<const std::uint32_t> DrawIndices(std::size_t first);
  void CopyBlock(std::span<const std::uint32_t> indices, float* block) const;
  void DrawAlbedo(double cos_i, Minibatches* to);

  FitProblem problem_;
  Encoding encoding_;
  std::size_t batch_;
  int energy_angles_;
  std::mt19937_64 random_;
  std::vector<float> rows_;           // sample after sample, Minibatches::kRows numbers each
  std::vector<std::uint32_t> order_;  // a permutation of the samples
  std::size_t next_ = 0;              // minibatch of the epoch
};

}  // namespace pbnbrdf
