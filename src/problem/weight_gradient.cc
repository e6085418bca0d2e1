#include "pbnbrdf/problem/weight_gradient.h"

#include <algorithm>

namespace pbnbrdf {

using kernels::Padded;

template <typename T>
WeightGradient<T>::WeightGradient(const NetworkShape& shape) : shape_(shape) {
  for (int l = 0; l < shape.num_layers(); ++l) {
    layers_.emplace_back(Padded(shape.out(l)) * Padded(shape.in(l) + 1));
  }
}

template <typename T>
void WeightGradient<T>::Clear() {
  for (auto& layer : layers_) std::fill(layer.begin(), layer.end(), 0.0);
}

template <typename T>
void WeightGradient<T>::AddBatch(const BatchedMlp<T>& mlp, int layer, const T* delta, int stride) {
  const int columns = shape_.in(layer) + 1;
  kernels::AddTransposedProduct(delta, shape_.out(layer), stride, mlp.layer_input(layer), columns,
                                Padded(columns), layers_[layer].data());
}

template <typename T>
void WeightGradient<T>::Add(const WeightGradient& other) {
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    for (std::size_t i = 0; i < layers_[l].size(); ++i) layers_[l][i] += other.layers_[l][i];
  }
}

template <typename T>
void WeightGradient<T>::AddTo(double* gradient) const {
  for (int l = 0; l < shape_.num_layers(); ++l) {
    const int columns = shape_.in(l) + 1;
    for (int o = 0; o < shape_.out(l); ++o) {
      const double* from = layers_[l].data() + o * Padded(columns);
      for (int i = 0; i < columns; ++i) *gradient++ += from[i];
    }
  }
}

template class WeightGradient<float>;
template class WeightGradient<double>;

}  // namespace pbnbrdf
