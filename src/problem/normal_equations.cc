#include "problem/normal_equations.h"

#include <algorithm>

#include "base/parallel.h"
#include "kernels/kernels.h"
#include "kernels/products.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;
using kernels::kPad;
using kernels::Padded;

int PairCount(int a, int b, bool symmetric) { return symmetric ? a * (a + 1) / 2 : a * b; }

// A sample's stride in the array of pair products of inputs: an odd number of kPad elements, lest the
// samples of a column share a few sets of the cache.
int InputProductStride(int pairs) {
  const int units = Padded(pairs + kPad) / kPad;
  return (units | 1) * kPad;
}

void AddAll(const AlignedVector<double>& from, AlignedVector<double>* to) {
  for (std::size_t i = 0; i < from.size(); ++i) (*to)[i] += from[i];
}

// In tiles that stay in the cache.
void MirrorUpperTriangle(int p, double* matrix) {
  constexpr int kTile = 32;
  const int tiles = (p + kTile - 1) / kTile;
  ParallelFor(tiles, [&](std::size_t tile) {
    const int begin = static_cast<int>(tile) * kTile, end = std::min(p, begin + kTile);
    for (int first = 0; first < end; first += kTile) {
      for (int i = begin; i < end; ++i) {
        double* row = matrix + std::size_t{1} * i * p;
        for (int j = first; j < std::min(i, first + kTile); ++j) {
          row[j] = matrix[std::size_t{1} * j * p + i];
        }
      }
    }
  });
}

}  // namespace

template <typename T>
NormalEquations<T>::NormalEquations(const NetworkShape& shape) : shape_(shape) {
  int most_units = 0, most_inputs = 0;
  for (int l = 0; l < shape.num_layers(); ++l) {
    gradients_.emplace_back(shape.out(l) * Padded(shape.in(l) + 1));
    for (int m = l; m < shape.num_layers(); ++m) {
      const int units = PairCount(shape.out(l), shape.out(m), l == m);
      const int inputs = PairCount(shape.in(l) + 1, shape.in(m) + 1, l == m);
      const std::size_t size = std::size_t{1} * units * Padded(inputs);
      blocks_.push_back({l, m, units, inputs, AlignedVector<double>(size)});
      most_units = std::max(most_units, units);
      most_inputs = std::max(most_inputs, inputs);
    }
  }
  unit_products_.resize(std::size_t{kBatch} * most_units);
  input_products_.resize(std::size_t{kBatch} * InputProductStride(most_inputs));
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
  for (int l = 0; l < shape_.num_layers(); ++l) {
    // The sum over rows of r delta_l.
    T* weighted = unit_products_.data();
    kernels::SummedPairProducts(mlp.delta(l), shape_.out(l), residuals, 1, mlp.rows(),
                                /*symmetric=*/false, weighted);
    const int columns = shape_.in(l) + 1;
    kernels::AddProduct(weighted, shape_.out(l), mlp.layer_input(l), columns, Padded(columns),
                        gradients_[l].data());
  }
}

template <typename T>
void NormalEquations<T>::AddBlock(const BatchedMlp<T>& mlp, Block* block) {
  const auto [l, m] = std::pair(block->l, block->m);
  const int input_stride = InputProductStride(block->input_pairs);
  kernels::SummedPairProducts(mlp.delta(l), shape_.out(l), mlp.delta(m), shape_.out(m), mlp.rows(),
                              l == m, unit_products_.data());
  kernels::PairProducts(mlp.layer_input(l), shape_.in(l) + 1, mlp.layer_input(m), shape_.in(m) + 1,
                        l == m, input_products_.data(), input_stride);
  kernels::AddProduct(unit_products_.data(), block->unit_pairs, input_products_.data(),
                      block->input_pairs, input_stride, block->sums.data());
}

template <typename T>
void NormalEquations<T>::Add(std::span<const NormalEquations* const> others) {
  for (const NormalEquations* other : others) {
    for (std::size_t l = 0; l < gradients_.size(); ++l) {
      AddAll(other->gradients_[l], &gradients_[l]);
    }
  }
  ParallelFor(blocks_.size(), [&](std::size_t b) {
    for (const NormalEquations* other : others) AddAll(other->blocks_[b].sums, &blocks_[b].sums);
  });
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
  ParallelFor(blocks_.size(), [&](std::size_t b) { AddToUpperTriangle(blocks_[b], hessian); });
  MirrorUpperTriangle(shape_.num_weights(), hessian);
}

template <typename T>
void NormalEquations<T>::AddToUpperTriangle(const Block& block, double* hessian) const {
  const auto [l, m] = std::pair(block.l, block.m);
  const bool symmetric = l == m;
  const int in_l = shape_.in(l) + 1, in_m = shape_.in(m) + 1;
  const std::size_t p = shape_.num_weights();
  const double* sums = block.sums.data();
  for (int o = 0; o < shape_.out(l); ++o) {
    for (int q = symmetric ? o : 0; q < shape_.out(m); ++q, sums += Padded(block.input_pairs)) {
      // The entry for weight (o, i) of layer l and weight (q, j) of layer m is to[i * p + j].
      double* to = hessian + (shape_.offset(l) + o * in_l) * p + shape_.offset(m) + q * in_m;
      const double* value = sums;
      for (int i = 0; i < in_l; ++i) {
        const int first = symmetric ? i : 0;
        for (int j = first; j < in_m; ++j) to[i * p + j] += value[j - first];
        // Within a layer, (o, j; q, i) has the same sum; if o == q it is in the lower triangle.
        if (symmetric && o != q) {
          for (int j = i + 1; j < in_m; ++j) to[j * p + i] += value[j - first];
        }
        value += in_m - first;
      }
    }
  }
}

template class NormalEquations<float>;
template class NormalEquations<double>;

}  // namespace pbnbrdf
