// sample_sums.h: sums over samples, shared among threads: the cost of the terms over samples, J'r and J'J.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "pbnbrdf/problem/linearization.h"
#include "problem/batch_pass.h"
#include "problem/log_term.h"
#include "problem/normal_equations.h"

namespace pbnbrdf {

// Batches are dealt to a fixed number of partial sums, which are added in order: the result doesn't
// depend on the threads that compute them. T is float or double.
template <typename T>
class SampleSums {
 public:
  // samples must outlive this.
  SampleSums(const NetworkShape& shape, const TermOptions& terms, const EncodedSamples& samples);

  std::size_t num_samples() const { return inputs_.size(); }
  void Grow(std::size_t count);

  double Cost(const T* weights) const;
  double MeanAbsLogError(const T* weights);

  // Adds cost and J'r of all samples.
  void AddGradient(const T* weights, Linearization* at);

  // The same, and J'J of a part of them, scaled up to stand for all.
  void AddCurvature(const T* weights, CurvaturePart part, Linearization* at);

 private:
  using Batches = std::vector<std::size_t>;

  // Partial sums.
  struct CurvatureSum {
    CurvatureSum(const NetworkShape& shape, const SampleTerms& terms)
        : pass(shape, terms, terms.rows()), sums(shape) {}
    BatchPass<T> pass;
    NormalEquations<T> sums;
    double cost = 0.0;
  };
  struct GradientSum {
    GradientSum(const NetworkShape& shape, const SampleTerms& terms)
        : pass(shape, terms, 1), of_batch(shape.num_weights()), sum(shape.num_weights()) {}
    BatchPass<T> pass;
    AlignedVector<T> of_batch;
    std::vector<double> sum;
    double cost = 0.0;
  };

  void AddGradientOf(const T* weights, const Batches& batches, Linearization* at);
  void AddCurvatureOf(const T* weights, const Batches& batches, Linearization* at);

  NetworkShape shape_;
  const EncodedSamples& samples_;
  SampleTerms terms_;
  EncodedBatches<T> inputs_;
  Batches all_batches_;
  std::optional<LogTerm> error_term_;                          // of MeanAbsLogError
  std::vector<std::unique_ptr<CurvatureSum>> curvature_sums_;  // one a partition
  std::vector<std::unique_ptr<GradientSum>> gradient_sums_;
};

extern template class SampleSums<float>;
extern template class SampleSums<double>;

}  // namespace pbnbrdf
