#include "pbnbrdf/problem/normal_equations.h"

#include <algorithm>

namespace pbnbrdf {
namespace {

using kernels::kBatch;
using kernels::kPad;
using kernels::Padded;

int PairCount(int a, int b, bool symmetric) { return symmetric ? a * (a + 1) / 2 : a * b; }

// A sample's stride in the arrays of pair products: an odd number of kPad elements, lest the
// samples of a column share a few sets of the cache.
int ProductStride(int pairs) {
  const int units = Padded(pairs + kPad) / kPad;
  return (units | 1) * kPad;
}

void AddAll(const AlignedVector<double>& from, AlignedVector<double>* to) {
  for (std::size_t i = 0; i < from.size(); ++i) (*to)[i] += from[i];
}

}  // namespace

template <typename T>
NormalEquations<T>::NormalEquations(const NetworkShape& shape) : shape_(shape) {
  int most_units = 0, most_inputs = 0;
  for (int l = 0; l < shape.num_layers(); ++l) {
    gradients_.emplace_back(Padded(shape.out(l)) * Padded(shape.in(l) + 1));
    for (int m = l; m < shape.num_layers(); ++m) {
      const int units = PairCount(shape.out(l), shape.out(m), l == m);
      const int inputs = PairCount(shape.in(l) + 1, shape.in(m) + 1, l == m);
      const std::size_t size = std::size_t{1} * Padded(units) * Padded(inputs);
      blocks_.push_back({l, m, units, inputs, AlignedVector<double>(size)});
      most_units = std::max(most_units, units);
      most_inputs = std::max(most_inputs, inputs);
    }
  }
  unit_products_.resize(std::size_t{kBatch} * ProductStride(most_units));
  input_products_.resize(std::size_t{kBatch} * ProductStride(most_inputs));
}

template <typename T>
void NormalEquations<T>::Clear() {
  for (auto& gradient : gradients_) std::fill(gradient.begin(), gradient.end(), 0.0);
  for (Block& block : blocks_) std::fill(block.sums.begin(), block.sums.end(), 0.0);
}

template <typename T>
void NormalEquations<T>::AddBatch(const BatchedMlp<T>& mlp, const T* residuals) {
  AddGradient(mlp, residuals);
  for (Block& block : blocks_) AddBlock(mlp, &block);
}

template <typename T>
void NormalEquations<T>::AddGradient(const BatchedMlp<T>& mlp, const T* residuals) {
  const int rows = mlp.rows();
  for (int l = 0; l < shape_.num_layers(); ++l) {
    const int out = shape_.out(l), padded = Padded(out);
    // sum over rows of r delta_l, by sample
    T* weighted = unit_products_.data();
    std::fill(weighted, weighted + kBatch * padded, T(0));
    const T* delta = mlp.delta(l);
    for (int n = 0; n < kBatch; ++n, weighted += padded) {
      for (int r = 0; r < rows; ++r, delta += padded) {
        const T residual = residuals[r * kBatch + n];
        for (int o = 0; o < out; ++o) weighted[o] += residual * delta[o];
      }
    }
    const int columns = shape_.in(l) + 1;
    kernels::AddTransposedProduct(unit_products_.data(), out, padded, mlp.layer_input(l), columns,
                                  Padded(columns), gradients_[l].data());
  }
}

template <typename T>
void NormalEquations<T>::AddBlock(const BatchedMlp<T>& mlp, Block* block) {
  const auto [l, m] = std::pair(block->l, block->m);
  const int unit_stride = ProductStride(block->unit_pairs);
  const int input_stride = ProductStride(block->input_pairs);
  kernels::PairProducts(mlp.delta(l), shape_.out(l), mlp.delta(m), shape_.out(m), mlp.rows(),
                        l == m, unit_products_.data(), unit_stride);
  kernels::PairProducts(mlp.layer_input(l), shape_.in(l) + 1, mlp.layer_input(m), shape_.in(m) + 1,
                        1, l == m, input_products_.data(), input_stride);
  kernels::AddTransposedProduct(unit_products_.data(), block->unit_pairs, unit_stride,
                                input_products_.data(), block->input_pairs, input_stride,
                                block->sums.data());
}

template <typename T>
void NormalEquations<T>::Add(const NormalEquations& other) {
  for (std::size_t l = 0; l < gradients_.size(); ++l) AddAll(other.gradients_[l], &gradients_[l]);
  for (std::size_t b = 0; b < blocks_.size(); ++b) AddAll(other.blocks_[b].sums, &blocks_[b].sums);
}

template <typename T>
void NormalEquations<T>::AddTo(double* gradient, double* hessian) const {
  for (int l = 0; l < shape_.num_layers(); ++l) {
    const int columns = shape_.in(l) + 1;
    for (int o = 0; o < shape_.out(l); ++o) {
      const double* from = gradients_[l].data() + o * Padded(columns);
      for (int i = 0; i < columns; ++i) *gradient++ += from[i];
    }
  }
  for (const Block& block : blocks_) Scatter(block, hessian);
}

template <typename T>
void NormalEquations<T>::Scatter(const Block& block, double* hessian) const {
  const auto [l, m] = std::pair(block.l, block.m);
  const bool symmetric = l == m;
  const int in_l = shape_.in(l) + 1, in_m = shape_.in(m) + 1;
  const std::size_t p = shape_.num_weights();
  // The entry for weight (o, i) of layer l and weight (q, j) of layer m, and its mirror image.
  const auto add = [&](int o, int i, int q, int j, double value) {
    const std::size_t row = shape_.offset(l) + o * in_l + i;
    const std::size_t column = shape_.offset(m) + q * in_m + j;
    hessian[row * p + column] += value;
    if (row != column) hessian[column * p + row] += value;
  };
  const double* sums = block.sums.data();
  for (int o = 0; o < shape_.out(l); ++o) {
    for (int q = symmetric ? o : 0; q < shape_.out(m); ++q, sums += Padded(block.input_pairs)) {
      const double* value = sums;
      for (int i = 0; i < in_l; ++i) {
        for (int j = symmetric ? i : 0; j < in_m; ++j, ++value) {
          add(o, i, q, j, *value);
          // Within a layer, (o, j; q, i) has the same sum; (o, i; q, j) stands for it if o == q.
          if (symmetric && o != q && i != j) add(o, j, q, i, *value);
        }
      }
    }
  }
}

template class NormalEquations<float>;
template class NormalEquations<double>;

}  // namespace pbnbrdf
