// sample_sums.h: sums over samples, shared among threads: the cost of the terms over samples, J'r and J'J.
#pragma once

#include <concepts>
#include <memory>
#include <vector>

#include "pbnbrdf/problem/linearization.h"
#include "problem/batch_pass.h"
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

  // The same, and J'J of a part of them, scaled up to stand for all. weights: in both precisions.
  void AddCurvature(const T* weights, const double* exact_weights, CurvaturePart part,
                    Linearization* at);

  // Objective::SumCurvatureInDouble.
  bool SumCurvatureInDouble() {
    if (std::same_as<T, double> || curvature_in_double_) return false;
    curvature_in_double_ = true;
    curvature_sums_.clear();
    return true;
  }

  // Objective::Curve; always in double precision.
  std::vector<double> Curve(const double* weights, const double* direction, CurvaturePart part);

 private:
  using Batches = std::vector<std::size_t>;

  // The batches of a part, those that aren't, and how many times the samples of the part make all.
  struct Division {
    Batches part, rest;
    double scale;
  };

  // Partial sums.
  template <typename U>
  struct CurvatureSum {
    CurvatureSum(const NetworkShape& shape, const SampleTerms& terms)
        : pass(shape, terms, terms.rows()), sums(shape) {}
    BatchPass<U> pass;
    NormalEquations<U> sums;
    double cost = 0.0;
  };
  template <typename U>
  struct GradientSum {
    GradientSum(const NetworkShape& shape, const SampleTerms& terms)
        : pass(shape, terms, 1), of_batch(shape.num_weights()), sum(shape.num_weights()) {}
    BatchPass<U> pass;
    AlignedVector<U> of_batch;
    std::vector<double> sum;
    double cost = 0.0;
  };

  Division Divide(CurvaturePart part) const;
  template <typename U, typename Add>
  std::size_t SumGradients(const Batches& batches,
                           std::vector<std::unique_ptr<GradientSum<U>>>* sums, Add add);
  void AddGradientOf(const T* weights, const Batches& batches, Linearization* at);
  template <typename U>
  void AddCurvatureOf(const U* weights, const EncodedBatches<U>& inputs, const Batches& batches,
                      std::vector<std::unique_ptr<CurvatureSum<U>>>* sums, Linearization* at);

  NetworkShape shape_;
  const EncodedSamples& samples_;
  SampleTerms terms_;
  EncodedBatches<T> inputs_;
  Batches all_batches_;
  bool curvature_in_double_ = false;
  std::unique_ptr<SampleTerm> error_term_;  // of MeanAbsLogError
  // One a partition.
  std::vector<std::unique_ptr<CurvatureSum<T>>> curvature_sums_;
  std::vector<std::unique_ptr<CurvatureSum<double>>> exact_curvature_sums_;
  std::vector<std::unique_ptr<GradientSum<T>>> gradient_sums_;
  std::vector<std::unique_ptr<GradientSum<double>>> curve_sums_;
};

extern template class SampleSums<float>;
extern template class SampleSums<double>;

}  // namespace pbnbrdf
