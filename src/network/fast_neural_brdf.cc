#include "network/fast_neural_brdf.h"

#include <algorithm>

#include "network/batched_mlp.h"
#include "network/evaluation.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

using kernels::kBatch;

FastNeuralBrdf::FastNeuralBrdf(const NeuralBrdf& network)
    : shape_(network.shape()),
      weights_(network.weights().begin(), network.weights().end()),
      description_(StrCat(network.Description(), ", single precision")) {}

void FastNeuralBrdf::EvaluateUnclipped(std::span<const DirectionPair> pairs,
                                       std::span<Rgb> values) const {
  BatchedMlp<float> mlp(shape_, /*rows=*/0);
  AlignedVector<float> inputs(shape_.in(0) * kBatch);
  const auto evaluate = [&](const DirectionPair* from, Rgb* to) {
    EncodeBatch(shape_.encoding(), from, inputs.data());
    mlp.Forward(weights_.data(), inputs.data());
    ReflectanceBatch(mlp.output(), to);
  };
  std::size_t n = 0;
  for (; n + kBatch <= pairs.size(); n += kBatch) evaluate(&pairs[n], &values[n]);
  if (n == pairs.size()) return;
  std::array<DirectionPair, kBatch> rest = {};
  std::array<Rgb, kBatch> rest_values;
  std::copy(pairs.begin() + n, pairs.end(), rest.begin());
  evaluate(rest.data(), rest_values.data());
  std::copy_n(rest_values.begin(), pairs.size() - n, values.begin() + n);
}

std::string FastNeuralBrdf::Description() const { return description_; }

}  // namespace pbnbrdf
