#include "jacobian_methods.h"

#include <ceres/crs_matrix.h>
#include <ceres/jet.h>
#include <ceres/problem.h>

#include <algorithm>
#include <memory>

#include "matrix_product.h"
#include "network/batched_mlp.h"
#include "network/encoded_batches.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/problem/objective.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "problem/robust_loss.h"

namespace pbnbrdf {
namespace {

constexpr int kChannels = NetworkShape::kChannels;
constexpr int kBatch = kernels::kBatch;
constexpr int kRows = LogResidual::kNumResiduals;
constexpr std::size_t kChunk = 8;  // batches whose rows of J are in memory at once

class AutodiffEvaluation {
 public:
  AutodiffEvaluation(const FitProblem& problem, std::span<const BrdfSample> samples)
      : weights_(problem.Shape().num_weights()) {
    AddAutodiff(problem, samples, EqualStrata(problem), weights_.data(), &ceres_problem_);
  }

  void Evaluate(const double* weights, Linearization* at) {
    std::copy_n(weights, weights_.size(), weights_.begin());
    std::vector<double> residuals;
    ceres::CRSMatrix jacobian;  // each residual depends on all weights: all rows are full
    ceres_problem_.Evaluate({}, &at->cost, &residuals, &at->gradient, &jacobian);
    at->hessian.assign(weights_.size() * weights_.size(), 0.0);
    AddProductWithItself(jacobian.values.data(), jacobian.num_rows, jacobian.num_cols,
                         at->hessian.data());
  }

 private:
  std::vector<double> weights_;
  ceres::Problem ceres_problem_;
};

class DenseEvaluation {
 public:
  DenseEvaluation(const FitProblem& problem, std::span<const BrdfSample> samples)
      : shape_(problem.Shape()),
        mlp_(shape_, kRows),
        loss_(problem.terms),
        sample_weight_(problem.terms.Weight("log") / static_cast<double>(samples.size())),
        jacobian_(kChunk * kRows * kBatch * shape_.num_weights()),
        residuals_(kChunk * kRows * kBatch),
        product_(std::size_t(shape_.num_weights()) * shape_.num_weights()) {
    inputs_.Reserve(samples.size());
    for (const BrdfSample& s : samples) {
      inputs_.Add(Encode(shape_.encoding(), s.pair));
      terms_.emplace_back(s.value, CosI(s.pair));
    }
  }

  void Evaluate(const double* weights, Linearization* at) {
    const AlignedVector<float> w(weights, weights + shape_.num_weights());
    at->cost = 0.0;
    at->gradient.assign(shape_.num_weights(), 0.0);
    at->hessian.assign(product_.size(), 0.0);
    for (std::size_t first = 0; first < inputs_.num_batches(); first += kChunk) {
      const std::size_t end = std::min(first + kChunk, inputs_.num_batches());
      std::size_t row = 0;
      for (std::size_t b = first; b < end; ++b) {
        at->cost += AppendBatch(w.data(), b, row);
        row += kRows * inputs_.batch_size(b);
      }
      AddProducts(row, at);
    }
  }

 private:
  using Jet = ceres::Jet<double, kChannels>;

  // Writes the rows of J and residuals of batch b from `row` on. Returns the cost.
  double AppendBatch(const float* weights, std::size_t b, std::size_t row) {
    mlp_.Forward(weights, inputs_.batch(b));
    double cost = 0.0;
    for (int n = 0; n < inputs_.batch_size(b); ++n) {
      cost += LinearizeOutputs(b, n, &residuals_[row + kRows * n]);
    }
    mlp_.Backward(weights);
    mlp_.TransposeInputs();
    for (int n = 0; n < inputs_.batch_size(b); ++n) WriteRows(n, row + kRows * n);
    return cost;
  }

  // Of sample n of batch b: the residuals, and the first gradients of the backward passes. Returns
  // the cost.
  double LinearizeOutputs(std::size_t b, int n, double* residuals) {
    Jet z[kChannels], r[kRows];
    for (int c = 0; c < kChannels; ++c) z[c] = Jet(mlp_.output()[c * kBatch + n], c);
    terms_[b * kBatch + n](z, r);
    double squared_norm = 0.0;
    for (const Jet& residual : r) squared_norm += residual.a * residual.a;
    const RobustWeight weight = loss_.At(sample_weight_, squared_norm);
    for (int row = 0; row < kRows; ++row) {
      residuals[row] = weight.row_scale * r[row].a;
      for (int c = 0; c < kChannels; ++c) {
        mlp_.output_gradient(row)[c * kBatch + n] =
            static_cast<float>(weight.row_scale * r[row].v[c]);
      }
    }
    return weight.cost;
  }

  // The rows of J of the batch's sample n, from `first` on.
  void WriteRows(int n, std::size_t first) {
    float* to = jacobian_.data() + first * shape_.num_weights();
    for (int row = 0; row < kRows; ++row) {
      for (int layer = 0; layer < shape_.num_layers(); ++layer) {
        const int in = shape_.in(layer) + 1, out = shape_.out(layer);
        const float* delta = mlp_.delta(layer) + std::size_t(row) * out * kBatch + n;
        const float* input = mlp_.layer_input(layer) + std::size_t(n) * kernels::Padded(in);
        for (int o = 0; o < out; ++o) {
          for (int i = 0; i < in; ++i) to[i] = delta[o * kBatch] * input[i];
          to += in;
        }
      }
    }
  }

  // Adds J'J and J'r of the first rows.
  void AddProducts(std::size_t rows, Linearization* at) {
    const int p = shape_.num_weights();
    std::fill(product_.begin(), product_.end(), 0.0f);
    AddProductWithItself(jacobian_.data(), static_cast<int>(rows), p, product_.data());
    for (std::size_t i = 0; i < product_.size(); ++i) at->hessian[i] += product_[i];
    for (std::size_t row = 0; row < rows; ++row) {
      const float* j = jacobian_.data() + row * p;
      for (int i = 0; i < p; ++i) at->gradient[i] += residuals_[row] * j[i];
    }
  }

  NetworkShape shape_;
  BatchedMlp<float> mlp_;
  RobustLoss loss_;
  double sample_weight_;
  EncodedBatches<float> inputs_;
  std::vector<LogResidual> terms_;
  AlignedVector<float> jacobian_;  // of a chunk, rows x P
  std::vector<double> residuals_;  // of a chunk
  AlignedVector<float> product_;   // P x P
};

// `Method`, kept alive by the function that evaluates it.
template <typename Method>
Evaluation Shared(std::shared_ptr<Method> method) {
  return [method](const double* weights, Linearization* at) { method->Evaluate(weights, at); };
}

}  // namespace

Evaluation MakeEvaluation(DerivativeMethod method, const FitProblem& problem,
                          std::span<const BrdfSample> samples) {
  switch (method) {
    case DerivativeMethod::kAutodiff:
      return Shared(std::make_shared<AutodiffEvaluation>(problem, samples));
    case DerivativeMethod::kDense:
      return Shared(std::make_shared<DenseEvaluation>(problem, samples));
    case DerivativeMethod::kCondensed:
      break;
  }
  const std::shared_ptr<Objective> objective = MakeObjective(problem, Precision::kSingle, samples);
  return
      [objective](const double* weights, Linearization* at) { objective->Linearize(weights, at); };
}

}  // namespace pbnbrdf
