// batched_mlp.h: passes of a network forward and backward for kernels::kBatch inputs at a time.
#pragma once

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// T is float or double. Holds the intermediate values of one batch, so each thread needs its own.
//
// Backward passes carry several rows at once: row r starts from the gradient of one residual with
// respect to the outputs z, different for each sample, and ends in delta_l, its gradient with
// respect to layer l's values before the activation. The gradient with respect to the layer's
// weights is then the outer product of delta_l and of the layer's input, 1 appended for the bias.
template <typename T>
class BatchedMlp {
 public:
  static constexpr int kBatch = kernels::kBatch;

  // rows: of the backward pass; 0 if there is none.
  BatchedMlp(const NetworkShape& shape, int rows);

  const NetworkShape& shape() const { return shape_; }
  int rows() const { return rows_; }

  // weights: shape().num_weights(); input: by feature, in(0) x kBatch, must outlive Backward.
  void Forward(const T* weights, const T* input);

  // z, before the output unit. By feature, kChannels x kBatch; of a network with one output this is
  // kChannels times the same.
  const T* output() const { return activations_.back().data(); }
  T* output() { return activations_.back().data(); }

  // To be filled before Backward. By feature, kChannels x kBatch.
  T* output_gradient(int row) { return output_gradients().data() + row * kChannels * kBatch; }

  // After Forward with the same weights.
  void Backward(const T* weights);

  // After Backward: gradient += the sum over samples of a row's gradient with respect to all weights.
  void AddWeightGradient(int row, T* gradient) const;

  // After Backward: a row after the other, each by feature, out(layer) x kBatch.
  const T* delta(int layer) const { return deltas_[layer].data(); }

  // After Forward: makes the layers' inputs available by sample, kPad readable elements after the
  // last (kernels.h):
  void TransposeInputs();

  // in(layer) values and 1, stride Padded(in + 1).
  const T* layer_input(int layer) const { return inputs_by_sample_[layer].data(); }

 private:
  static constexpr int kChannels = NetworkShape::kChannels;

  bool HasOneOutput() const { return shape_.num_outputs() == 1; }
  AlignedVector<T>& output_gradients() {
    return HasOneOutput() ? channel_gradients_ : deltas_.back();
  }
  void RepeatOutput();
  void SumChannelGradients();
  void BackwardRow(const T* weights, int row);

  NetworkShape shape_;
  int rows_;
  const T* input_ = nullptr;
  AlignedVector<T> ones_;                      // the input of the biases, kBatch
  std::vector<AlignedVector<T>> activations_;  // [layer]: its output, by feature
  std::vector<AlignedVector<T>> deltas_;       // [layer]: row after row, by feature
  AlignedVector<T> channel_gradients_;         // of one output only: those of all channels
  std::vector<AlignedVector<T>> inputs_by_sample_;
};

extern template class BatchedMlp<float>;
extern template class BatchedMlp<double>;

}  // namespace pbnbrdf
