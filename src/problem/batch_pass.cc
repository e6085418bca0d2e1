#include "problem/batch_pass.h"

#include <algorithm>
#include <cmath>

namespace pbnbrdf {

WeightsAlong::WeightsAlong(const double* weights, const double* direction, int size)
    : behind(weights, weights + size), here(behind), ahead(behind) {
  for (int i = 0; i < size; ++i) {
    behind[i] -= kStep * direction[i];
    ahead[i] += kStep * direction[i];
  }
}

int SampleTerms::rows() const {
  int rows = 0;
  for (const WeightedSampleTerm& term : terms) rows += term.term->rows();
  return rows;
}

template <typename T>
BatchPass<T>::BatchPass(const NetworkShape& shape, const SampleTerms& terms, int rows)
    : terms_(terms),
      mlp_(shape, rows),
      z_(kChannels * kBatch),
      sum_(kChannels * kBatch),
      residuals_(static_cast<std::size_t>(rows) * kBatch) {
  for (const WeightedSampleTerm& term : terms.terms) batches_.emplace_back(term.term->rows());
}

template <typename T>
void BatchPass<T>::Forward(const T* weights, const T* input) {
  mlp_.Forward(weights, input);
  std::copy_n(mlp_.output(), kChannels * kBatch, z_.begin());
}

template <typename T>
double BatchPass<T>::SquaredNorm(const TermBatch& batch, int rows, int n) const {
  double sum = 0.0;
  for (int row = 0; row < rows; ++row) {
    const double r = batch.residuals[row * kBatch + n];
    sum += r * r;
  }
  return sum;
}

template <typename T>
double BatchPass<T>::Cost(const T* weights, const T* input, std::size_t b, int size) {
  Forward(weights, input);
  double cost = 0.0;
  for (std::size_t t = 0; t < batches_.size(); ++t) {
    const SampleTerm& term = *terms_.terms[t].term;
    term.EvaluateResiduals(b, size, z_.data(), &batches_[t]);
    for (int n = 0; n < size; ++n) {
      const double weight = terms_.WeightOf(terms_.terms[t], b * kBatch + n);
      if (terms_.loss.is_absolute()) {
        double sum = 0.0;
        for (int row = 0; row < term.rows(); ++row) {
          sum += std::abs(batches_[t].residuals[row * kBatch + n]);
        }
        cost += weight / term.rows() * sum;
      } else {
        cost += terms_.loss.At(weight, SquaredNorm(batches_[t], term.rows(), n)).cost;
      }
    }
  }
  return cost;
}

// So that the places behind the last sample of a batch add nothing.
template <typename T>
void BatchPass<T>::ClearRows() {
  std::fill(residuals_.begin(), residuals_.end(), T(0));
  for (int row = 0; row < mlp_.rows(); ++row) {
    T* gradient = mlp_.output_gradient(row);
    std::fill(gradient, gradient + kChannels * kBatch, T(0));
  }
}

template <typename T>
void BatchPass<T>::Linearize(const T* weights, const T* input, std::size_t b, int size,
                             double* cost) {
  Forward(weights, input);
  if (size < kBatch) ClearRows();
  double scales[kBatch];
  int to_row = 0;
  for (std::size_t t = 0; t < batches_.size(); ++t) {
    const SampleTerm& term = *terms_.terms[t].term;
    TermBatch& batch = batches_[t];
    term.Evaluate(b, size, z_.data(), &batch);
    for (int n = 0; n < size; ++n) {
      const RobustWeight robust = terms_.loss.At(terms_.WeightOf(terms_.terms[t], b * kBatch + n),
                                                 SquaredNorm(batch, term.rows(), n));
      *cost += robust.cost;
      scales[n] = robust.row_scale;
    }
    for (int row = 0; row < term.rows(); ++row, ++to_row) {
      T* residuals = &residuals_[to_row * kBatch];
      for (int n = 0; n < size; ++n) {
        residuals[n] = static_cast<T>(scales[n] * batch.residuals[row * kBatch + n]);
      }
      for (int c = 0; c < kChannels; ++c) {
        const double* slopes = &batch.slopes[(row * kChannels + c) * kBatch];
        T* gradient = mlp_.output_gradient(to_row) + c * kBatch;
        for (int n = 0; n < size; ++n) gradient[n] = static_cast<T>(scales[n] * slopes[n]);
      }
    }
  }
  mlp_.Backward(weights);
  mlp_.TransposeInputs();
}

template <typename T>
void BatchPass<T>::AddGradient(const T* weights, const T* input, std::size_t b, int size,
                               T* gradient, double* cost) {
  Forward(weights, input);
  std::fill(sum_.begin(), sum_.end(), 0.0);
  for (std::size_t t = 0; t < batches_.size(); ++t) {
    const SampleTerm& term = *terms_.terms[t].term;
    term.Evaluate(b, size, z_.data(), &batches_[t]);
    if (terms_.loss.is_absolute()) {
      AddAbsolutes(t, b, size, cost);
    } else {
      AddSquares(t, b, size, batches_[t].residuals.data(), cost);
    }
  }
  BackwardSum(weights, gradient);
}

template <typename T>
void BatchPass<T>::AddCurve(const WeightsAlong& weights, const T* input, std::size_t b, int size,
                            T* gradient) requires std::same_as<T, double> {
  if constexpr (std::same_as<T, double>) {  // Clang 14 instantiates it for float, too
    constexpr double kPerStep = 1.0 / (WeightsAlong::kStep * WeightsAlong::kStep);
    second_.resize(batches_.size());
    for (std::size_t t = 0; t < batches_.size(); ++t) {
      second_[t].assign(batches_[t].residuals.size(), 0.0);
    }
    AddResiduals(weights.behind.data(), input, b, size, kPerStep);
    AddResiduals(weights.ahead.data(), input, b, size, kPerStep);
    AddResiduals(weights.here.data(), input, b, size, -2.0 * kPerStep);
    std::fill(sum_.begin(), sum_.end(), 0.0);
    double cost = 0.0;  // not asked for
    for (std::size_t t = 0; t < batches_.size(); ++t) {
      terms_.terms[t].term->Evaluate(b, size, z_.data(), &batches_[t]);
      AddSquares(t, b, size, second_[t].data(), &cost);
    }
    BackwardSum(weights.here.data(), gradient);
  }
}

// Adds `scale` times the residuals to second_.
template <typename T>
void BatchPass<T>::AddResiduals(const T* weights, const T* input, std::size_t b, int size,
                                double scale) {
  Forward(weights, input);
  for (std::size_t t = 0; t < batches_.size(); ++t) {
    const SampleTerm& term = *terms_.terms[t].term;
    term.EvaluateResiduals(b, size, z_.data(), &batches_[t]);
    for (int row = 0; row < term.rows(); ++row) {
      for (int n = row * kBatch; n < row * kBatch + size; ++n) {
        second_[t][n] += scale * batches_[t].residuals[n];
      }
    }
  }
}

// From sum_, the gradient with respect to the outputs.
template <typename T>
void BatchPass<T>::BackwardSum(const T* weights, T* gradient) {
  std::copy(sum_.begin(), sum_.end(), mlp_.output_gradient(0));
  mlp_.Backward(weights);
  mlp_.AddWeightGradient(0, gradient);
}

// factors: by row and sample, what each row is multiplied by; the residuals for J'r.
template <typename T>
void BatchPass<T>::AddSquares(std::size_t t, std::size_t b, int size, const double* factors,
                              double* cost) {
  const TermBatch& batch = batches_[t];
  const int rows = terms_.terms[t].term->rows();
  for (int n = 0; n < size; ++n) {
    const double weight = terms_.WeightOf(terms_.terms[t], b * kBatch + n);
    const RobustWeight robust = terms_.loss.At(weight, SquaredNorm(batch, rows, n));
    *cost += robust.cost;
    for (int row = 0; row < rows; ++row) {
      const double factor = robust.row_scale * factors[row * kBatch + n];
      for (int c = 0; c < kChannels; ++c) {
        const double slope = robust.row_scale * batch.slopes[(row * kChannels + c) * kBatch + n];
        sum_[c * kBatch + n] += factor * slope;
      }
    }
  }
}

// The sum of absolute values has the gradient of a sum of products with the signs.
template <typename T>
void BatchPass<T>::AddAbsolutes(std::size_t t, std::size_t b, int size, double* cost) {
  const TermBatch& batch = batches_[t];
  const int rows = terms_.terms[t].term->rows();
  for (int n = 0; n < size; ++n) {
    const double weight = terms_.WeightOf(terms_.terms[t], b * kBatch + n);
    double sum = 0.0;
    for (int row = 0; row < rows; ++row) {
      const double r = batch.residuals[row * kBatch + n];
      sum += std::abs(r);
      for (int c = 0; c < kChannels; ++c) {
        sum_[c * kBatch + n] +=
            weight / rows * Sign(r) * batch.slopes[(row * kChannels + c) * kBatch + n];
      }
    }
    *cost += weight / rows * sum;
  }
}

template class BatchPass<float>;
template class BatchPass<double>;

}  // namespace pbnbrdf
