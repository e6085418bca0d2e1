// weight_gradient.h: a sum over samples of delta_l x a_l for all layers l: the gradient of a
// network's weights (batched_mlp.h). Batches are summed in precision T, the whole in double.
#pragma once

#include <vector>

#include "pbnbrdf/base/aligned_vector.h"
#include "pbnbrdf/network/batched_mlp.h"

namespace pbnbrdf {

template <typename T>
class WeightGradient {
 public:
  explicit WeightGradient(const NetworkShape& shape);

  void Clear();

  // mlp: after Forward and Backward. delta: out(layer) values by sample, `stride` >= Padded(out).
  void AddBatch(const BatchedMlp<T>& mlp, int layer, const T* delta, int stride);

  void Add(const WeightGradient& other);

  // gradient[i] += the sum for weight i, shape.num_weights() of them.
  void AddTo(double* gradient) const;

 private:
  NetworkShape shape_;
  std::vector<AlignedVector<double>> layers_;  // Padded(out) x Padded(in + 1)
};

extern template class WeightGradient<float>;
extern template class WeightGradient<double>;

}  // namespace pbnbrdf
