// normal_equations.h: J'J and J'r of a network's residuals, accumulated batch by batch without ever
// holding J.
//
// The rows of J for the weights of layer l are delta_l x a_l (a_l: the layer's input with 1
// appended), so the block of J'J for layers l, m is
//
//   sum over samples n of (sum over rows r of delta_l,r delta_m,r') (x) (a_l a_m'):
//
// the sum over rows comes first, and the rest is one tall matrix product of pair products, of which
// the symmetric halves suffice where l = m. For 675 weights that is 0.35 MFLOP a sample, against
// 1.4 for J'J with three rows. Batches are summed in precision T, the whole in double.
#pragma once

#include <span>
#include <vector>

#include "base/aligned_vector.h"
#include "network/batched_mlp.h"

namespace pbnbrdf {

template <typename T>
class NormalEquations {
 public:
  explicit NormalEquations(const NetworkShape& shape);

  void Clear();

  // mlp: after Backward and TransposeInputs, its rows scaled by sqrt(weight). residuals: row after
  // row, rows x kBatch, scaled alike.
  void AddBatch(const BatchedMlp<T>& mlp, const T* residuals);

  // In the order given. In parallel, as AddTo.
  void Add(std::span<const NormalEquations* const> others);

  // Adds the sums to gradient (P) and hessian (P x P, symmetric).
  void AddTo(double* gradient, double* hessian) const;

 private:
  // The block of J'J for two layers: rows are pairs of their units, columns pairs of their inputs.
  struct Block {
    int l, m;
    int unit_pairs, input_pairs;
    AlignedVector<double> sums;
  };

  void AddGradient(const BatchedMlp<T>& mlp, const T* residuals);
  void AddBlock(const BatchedMlp<T>& mlp, Block* block);
  void AddToUpperTriangle(const Block& block, double* hessian) const;

  NetworkShape shape_;
  std::vector<Block> blocks_;
  AlignedVector<T> unit_products_, input_products_;  // of one batch: by feature, by sample
  std::vector<AlignedVector<double>> gradients_;     // [layer]: out x Padded(in + 1)
};

extern template class NormalEquations<float>;
extern template class NormalEquations<double>;

}  // namespace pbnbrdf
