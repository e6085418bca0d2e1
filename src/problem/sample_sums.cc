#include "problem/sample_sums.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "pbnbrdf/residuals/log_residual.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;

// More partitions than this wouldn't be shared better by a desktop's cores; fewer batches than that
// aren't worth a sum of their own, which is cleared and added.
constexpr std::size_t kMaxPartitions = 8, kMinBatchesPerPartition = 4;

std::size_t PartitionCount(std::size_t batches) {
  return std::clamp<std::size_t>(batches / kMinBatchesPerPartition, 1, kMaxPartitions);
}

// Calls run(p, count) in parallel for each partition p, which has the batches p, p + count, ... Returns
// count.
template <typename Run>
std::size_t ForEachPartition(std::size_t batches, Run run) {
  const std::size_t count = PartitionCount(batches);
  ParallelFor(count, [&](std::size_t p) { run(p, count); });
  return count;
}

// One for each partition.
template <typename Sum>
void MakeSums(const NetworkShape& shape, const SampleTerms& terms, std::size_t batches,
              std::vector<std::unique_ptr<Sum>>* sums) {
  while (sums->size() < PartitionCount(batches)) {
    sums->push_back(std::make_unique<Sum>(shape, terms));
  }
}

double Total(const std::vector<double>& sums) {
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

template <typename T>
SampleSums<T>::SampleSums(const NetworkShape& shape, const TermOptions& terms,
                          const EncodedSamples& samples)
    : shape_(shape),
      samples_(samples),
      terms_{MakeSampleTerms(terms), RobustLoss(terms), &samples} {}

template <typename T>
void SampleSums<T>::Grow(std::size_t count) {
  for (std::size_t n = inputs_.size(); n < count; ++n) terms_.total_weight += samples_.weight(n);
  inputs_.Add(samples_.inputs(), inputs_.size(), count);
  for (const WeightedSampleTerm& term : terms_.terms) term.term->Grow(samples_, count);
  all_batches_.resize(inputs_.num_batches());
  std::iota(all_batches_.begin(), all_batches_.end(), std::size_t{0});
}

template <typename T>
double SampleSums<T>::Cost(const T* weights) const {
  std::vector<double> sums(kMaxPartitions, 0.0);
  ForEachPartition(inputs_.num_batches(), [&](std::size_t p, std::size_t partitions) {
    BatchPass<T> pass(shape_, terms_, 0);
    for (std::size_t b = p; b < inputs_.num_batches(); b += partitions) {
      sums[p] += pass.Cost(weights, inputs_.batch(b), b, inputs_.batch_size(b));
    }
  });
  return Total(sums);
}

template <typename T>
double SampleSums<T>::MeanAbsLogError(const T* weights) {
  if (!error_term_) error_term_ = FindTermType(LogResidual::kName)->make();
  error_term_->Grow(samples_, inputs_.size());
  std::vector<double> sums(kMaxPartitions, 0.0);
  ForEachPartition(inputs_.num_batches(), [&](std::size_t p, std::size_t partitions) {
    BatchedMlp<T> mlp(shape_, 0);
    TermBatch batch(error_term_->rows());
    AlignedVector<double> z(NetworkShape::kChannels * kBatch);
    for (std::size_t b = p; b < inputs_.num_batches(); b += partitions) {
      mlp.Forward(weights, inputs_.batch(b));
      std::transform(mlp.output(), mlp.output() + z.size(), z.begin(),
                     [](T output) { return static_cast<double>(std::max(output, T(0))); });
      const int size = inputs_.batch_size(b);
      error_term_->EvaluateResiduals(b, size, z.data(), &batch);
      double sum = 0.0;
      for (int n = 0; n < size; ++n) {
        for (int c = 0; c < NetworkShape::kChannels; ++c)
          sum += std::abs(batch.residuals[c * kBatch + n]);
      }
      sums[p] += sum;
    }
  });
  return Total(sums) / static_cast<double>(NetworkShape::kChannels * inputs_.size());
}

template <typename T>
void SampleSums<T>::AddGradient(const T* weights, Linearization* at) {
  AddGradientOf(weights, all_batches_, at);
}

template <typename T>
typename SampleSums<T>::Division SampleSums<T>::Divide(CurvaturePart part) const {
  part.count = std::clamp<std::size_t>(part.count, 1, all_batches_.size());
  Division division;
  double samples = 0.0;
  for (std::size_t b : all_batches_) {
    const bool is_part = b % part.count == part.index % part.count;
    (is_part ? division.part : division.rest).push_back(b);
    if (is_part) samples += inputs_.batch_size(b);
  }
  division.scale = static_cast<double>(inputs_.size()) / samples;
  return division;
}

template <typename T>
void SampleSums<T>::AddCurvature(const T* weights, const double* exact_weights, CurvaturePart part,
                                 Linearization* at) {
  const Division division = Divide(part);
  if (curvature_in_double_) {
    AddCurvatureOf(exact_weights, samples_.inputs(), division.part, &exact_curvature_sums_, at);
  } else {
    AddCurvatureOf(weights, inputs_, division.part, &curvature_sums_, at);
  }
  if (division.scale != 1.0) {
    for (double& entry : at->hessian) entry *= division.scale;
  }
  AddGradientOf(weights, division.rest, at);
}

template <typename T>
std::vector<double> SampleSums<T>::Curve(const double* weights, const double* direction,
                                         CurvaturePart part) {
  const Division division = Divide(part);
  const WeightsAlong along(weights, direction, shape_.num_weights());
  const std::size_t used = SumGradients(
      division.part, &curve_sums_, [&](GradientSum<double>* sum, std::size_t b, double* gradient) {
        sum->pass.AddCurve(along, samples_.inputs().batch(b), b, inputs_.batch_size(b), gradient);
      });
  std::vector<double> total(shape_.num_weights(), 0.0);
  for (std::size_t p = 0; p < used; ++p) {
    for (std::size_t k = 0; k < total.size(); ++k) {
      total[k] += division.scale * curve_sums_[p]->sum[k];
    }
  }
  return total;
}

// Adds cost, J'r and J'J of some batches, at least one.
template <typename T>
template <typename U>
void SampleSums<T>::AddCurvatureOf(const U* weights, const EncodedBatches<U>& inputs,
                                   const Batches& batches,
                                   std::vector<std::unique_ptr<CurvatureSum<U>>>* sums,
                                   Linearization* at) {
  MakeSums(shape_, terms_, batches.size(), sums);
  const std::size_t used = ForEachPartition(batches.size(), [&](std::size_t p, std::size_t step) {
    CurvatureSum<U>& sum = *(*sums)[p];
    sum.cost = 0.0;
    sum.sums.Clear();
    for (std::size_t i = p; i < batches.size(); i += step) {
      const std::size_t b = batches[i];
      sum.pass.Linearize(weights, inputs.batch(b), b, inputs_.batch_size(b), &sum.cost);
      sum.sums.AddBatch(sum.pass.mlp(), sum.pass.residuals());
    }
  });
  std::vector<const NormalEquations<U>*> others;
  for (std::size_t p = 0; p < used; ++p) {
    at->cost += (*sums)[p]->cost;
    if (p > 0) others.push_back(&(*sums)[p]->sums);
  }
  sums->front()->sums.Add(others);
  sums->front()->sums.AddTo(at->gradient.data(), at->hessian.data());
}

// Sums up what add(sum, b, gradient) adds to a gradient for each of some batches b. Returns how many
// partial sums there are.
template <typename T>
template <typename U, typename Add>
std::size_t SampleSums<T>::SumGradients(const Batches& batches,
                                        std::vector<std::unique_ptr<GradientSum<U>>>* sums,
                                        Add add) {
  MakeSums(shape_, terms_, batches.size(), sums);
  return ForEachPartition(batches.size(), [&](std::size_t p, std::size_t step) {
    GradientSum<U>& sum = *(*sums)[p];
    sum.cost = 0.0;
    std::fill(sum.sum.begin(), sum.sum.end(), 0.0);
    for (std::size_t i = p; i < batches.size(); i += step) {
      std::fill(sum.of_batch.begin(), sum.of_batch.end(), U(0));
      add(&sum, batches[i], sum.of_batch.data());
      for (std::size_t k = 0; k < sum.sum.size(); ++k) sum.sum[k] += sum.of_batch[k];
    }
  });
}

// Adds cost and J'r of some batches.
template <typename T>
void SampleSums<T>::AddGradientOf(const T* weights, const Batches& batches, Linearization* at) {
  const std::size_t used =
      SumGradients(batches, &gradient_sums_, [&](GradientSum<T>* sum, std::size_t b, T* gradient) {
        sum->pass.AddGradient(weights, inputs_.batch(b), b, inputs_.batch_size(b), gradient,
                              &sum->cost);
      });
  for (std::size_t p = 0; p < used; ++p) {
    const GradientSum<T>& sum = *gradient_sums_[p];
    at->cost += sum.cost;
    for (std::size_t k = 0; k < sum.sum.size(); ++k) at->gradient[k] += sum.sum[k];
  }
}

template class SampleSums<float>;
template class SampleSums<double>;

}  // namespace pbnbrdf
