// batch_pass.h: the terms over samples at one batch: through the network, and their derivatives back to
// the outputs of the network.
#pragma once

#include <concepts>
#include <span>
#include <vector>

#include "network/batched_mlp.h"
#include "problem/robust_loss.h"
#include "problem/terms.h"

namespace pbnbrdf {

// The terms, with weights that make each a weighted mean over the samples.
struct SampleTerms {
  std::vector<WeightedSampleTerm> terms;
  RobustLoss loss;
  const EncodedSamples* samples;
  double total_weight = 0.0;  // of the samples so far

  int rows() const;
  double WeightOf(const WeightedSampleTerm& term, std::size_t n) const {
    return term.weight * samples->weight(n) / total_weight;
  }
};

// Weights at three points of a line: -kStep, 0 and kStep times a direction away. Second differences over
// them are second derivatives but for terms of kStep^2; they need passes in double precision.
struct WeightsAlong {
  static constexpr double kStep = 1e-3;
  WeightsAlong(const double* weights, const double* direction, int size);

  AlignedVector<double> behind, here, ahead;
};

// Holds the intermediate values of one batch, so each thread needs its own. T is float or double.
template <typename T>
class BatchPass {
 public:
  // rows: of the backward pass: terms->rows(), 1, or 0 where there is none. terms must outlive this.
  BatchPass(const NetworkShape& shape, const SampleTerms& terms, int rows);

  const BatchedMlp<T>& mlp() const { return mlp_; }

  // input of the following: by feature, batch b of `size` samples.
  double Cost(const T* weights, const T* input, std::size_t b, int size);

  // A row for each residual, weighted by the robust loss, ready for NormalEquations<T>::AddBatch. Adds to
  // *cost.
  void Linearize(const T* weights, const T* input, std::size_t b, int size, double* cost);
  const T* residuals() const { return residuals_.data(); }

  // One row, the sum of all of a sample's rows times their residuals. Adds J'r to gradient (P) and to
  // *cost.
  void AddGradient(const T* weights, const T* input, std::size_t b, int size, T* gradient,
                   double* cost);

  // Adds J'r'' to gradient (P): r'', the second derivative along the line, in the place of r.
  void AddCurve(const WeightsAlong& weights, const T* input, std::size_t b, int size,
                T* gradient) requires std::same_as<T, double>;

 private:
  static constexpr int kChannels = NetworkShape::kChannels;
  static constexpr int kBatch = kernels::kBatch;

  void Forward(const T* weights, const T* input);
  void AddSquares(std::size_t t, std::size_t b, int size, const double* factors, double* cost);
  void AddResiduals(const T* weights, const T* input, std::size_t b, int size, double scale);
  void BackwardSum(const T* weights, T* gradient);
  void AddAbsolutes(std::size_t t, std::size_t b, int size, double* cost);
  double SquaredNorm(const TermBatch& batch, int rows, int n) const;
  void ClearRows();

  const SampleTerms& terms_;
  BatchedMlp<T> mlp_;
  std::vector<TermBatch> batches_;             // one a term
  AlignedVector<double> z_;                    // the outputs, kChannels x kBatch
  AlignedVector<double> sum_;                  // of rows times residuals, kChannels x kBatch
  AlignedVector<T> residuals_;                 // row after row
  std::vector<AlignedVector<double>> second_;  // of AddCurve: r'', a term after the other
};

extern template class BatchPass<float>;
extern template class BatchPass<double>;

}  // namespace pbnbrdf
