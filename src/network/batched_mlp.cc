#include "network/batched_mlp.h"

#include <algorithm>

#include "kernels/passes.h"
#include "kernels/products.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;

// delta *= the activation's slope, from its value y.
template <typename T>
void MultiplySlopes(Activation activation, const T* y, std::size_t count, T* delta) {
  if (activation == Activation::kRelu) return kernels::ReluSlopes(y, count, delta);
  for (std::size_t i = 0; i < count; ++i) delta[i] *= T(1) - y[i] * y[i];
}

// to[n * stride + i] = from[i * kBatch + n], in tiles that stay in the cache.
template <typename T>
void TransposeMatrix(const T* from, int size, T* to, int stride) {
  constexpr int kTile = 16;
  for (int first = 0; first < kBatch; first += kTile) {
    for (int i = 0; i < size; ++i) {
      for (int n = first; n < first + kTile; ++n) to[n * stride + i] = from[i * kBatch + n];
    }
  }
}

}  // namespace

template <typename T>
BatchedMlp<T>::BatchedMlp(const NetworkShape& shape, int rows)
    : shape_(shape), rows_(rows), ones_(rows > 0 ? kBatch : 0, T(1)) {
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    const int in = shape.in(layer), out = shape.out(layer);
    activations_.emplace_back(out * kBatch);
    if (rows == 0) continue;
    deltas_.emplace_back(rows * out * kBatch);
    const int stride = kernels::Padded(in + 1);
    AlignedVector<T>& inputs = inputs_by_sample_.emplace_back(kBatch * stride + kernels::kPad);
    for (int n = 0; n < kBatch; ++n) inputs[n * stride + in] = T(1);
  }
  activations_.back().resize(kChannels * kBatch);
  if (HasOneOutput()) channel_gradients_.resize(rows * kChannels * kBatch);
}

template <typename T>
void BatchedMlp<T>::Forward(const T* weights, const T* input) {
  input_ = input;
  for (int layer = 0; layer < shape_.num_layers(); ++layer) {
    T* output = activations_[layer].data();
    const bool hidden = layer + 1 < shape_.num_layers();
    const auto dense = !hidden                                    ? kernels::Dense<T>
                       : shape_.activation() == Activation::kTanh ? kernels::DenseTanh<T>
                                                                  : kernels::DenseRelu<T>;
    dense(weights + shape_.offset(layer), shape_.out(layer), shape_.in(layer), input, output);
    input = output;
  }
  if (HasOneOutput()) RepeatOutput();
}

template <typename T>
void BatchedMlp<T>::RepeatOutput() {
  T* z = output();
  for (int c = 1; c < kChannels; ++c) std::copy_n(z, kBatch, z + c * kBatch);
}

template <typename T>
void BatchedMlp<T>::SumChannelGradients() {
  static_assert(kChannels == 3);
  for (int row = 0; row < rows_; ++row) {
    const T* from = channel_gradients_.data() + row * kChannels * kBatch;
    T* sum = deltas_.back().data() + row * kBatch;
    for (int n = 0; n < kBatch; ++n) sum[n] = from[n] + from[kBatch + n] + from[2 * kBatch + n];
  }
}

template <typename T>
void BatchedMlp<T>::Backward(const T* weights) {
  if (HasOneOutput()) SumChannelGradients();
  for (int row = 0; row < rows_; ++row) BackwardRow(weights, row);
}

template <typename T>
void BatchedMlp<T>::BackwardRow(const T* weights, int row) {
  for (int layer = shape_.num_layers() - 1; layer > 0; --layer) {
    const AlignedVector<T>& y = activations_[layer - 1];
    T* delta = deltas_[layer - 1].data() + row * y.size();
    kernels::DenseTransposed(weights + shape_.offset(layer), shape_.out(layer), shape_.in(layer),
                             deltas_[layer].data() + row * shape_.out(layer) * kBatch, delta);
    MultiplySlopes(shape_.activation(), y.data(), y.size(), delta);
  }
}

template <typename T>
void BatchedMlp<T>::AddWeightGradient(int row, T* gradient) const {
  for (int layer = 0; layer < shape_.num_layers(); ++layer) {
    const int in = shape_.in(layer), out = shape_.out(layer);
    const T* input = layer == 0 ? input_ : activations_[layer - 1].data();
    const T* delta = deltas_[layer].data() + row * out * kBatch;
    T* to = gradient + shape_.offset(layer);
    kernels::AddRowProducts(T(1), delta, out, kBatch, input, in, kBatch, kBatch, to, in + 1);
    kernels::AddRowProducts(T(1), delta, out, kBatch, ones_.data(), 1, kBatch, kBatch, to + in,
                            in + 1);
  }
}

template <typename T>
void BatchedMlp<T>::TransposeInputs() {
  for (int layer = 0; layer < shape_.num_layers(); ++layer) {
    const int in = shape_.in(layer);
    TransposeMatrix(layer == 0 ? input_ : activations_[layer - 1].data(), in,
                    inputs_by_sample_[layer].data(), kernels::Padded(in + 1));
  }
}

template class BatchedMlp<float>;
template class BatchedMlp<double>;

}  // namespace pbnbrdf
