#include "pbnbrdf/problem/objective.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "network/batched_mlp.h"
#include "network/encoded_batches.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "problem/energy_term.h"
#include "problem/normal_equations.h"
#include "problem/point_terms.h"

namespace pbnbrdf {
namespace {

constexpr int kChannels = NetworkShape::kChannels;
constexpr int kBatch = kernels::kBatch;

// Batches are dealt to a fixed number of partial sums, which are added in order: the result then
// doesn't depend on the threads that compute them.
constexpr std::size_t kMostPartitions = 8;
constexpr std::size_t kBatchesPerPartition = 4;

std::size_t PartitionCount(std::size_t batches) {
  return std::clamp<std::size_t>(batches / kBatchesPerPartition, 1, kMostPartitions);
}

template <typename T>
class BatchedObjective final : public Objective {
 public:
  BatchedObjective(const FitProblem& problem, std::span<const BrdfSample> samples,
                   std::span<const EnergyStratum> strata)
      : shape_(problem.Shape()),
        log_(problem.log_weight, problem, samples),
        chromaticity_(problem.chromaticity_weight, problem, samples),
        energy_(problem, strata) {
    inputs_.Reserve(samples.size());
    for (const BrdfSample& s : samples) inputs_.Add(Encode(shape_.encoding(), s.pair));
    all_batches_.resize(inputs_.num_batches());
    std::iota(all_batches_.begin(), all_batches_.end(), std::size_t{0});
  }

  const NetworkShape& shape() const override { return shape_; }

  std::size_t num_samples() const override { return inputs_.size(); }

  double HessianRounding() const override { return 10.0 * std::numeric_limits<T>::epsilon(); }

  double Cost(const double* weights) override {
    const AlignedVector<T> w = Converted(weights);
    const double cost = Sum(w, [&](std::size_t b, const T* output, LogTerm::Batch* log) {
      log_.Evaluate(b, output, log);
      double sum = 0.0;
      for (int n = 0; n < inputs_.batch_size(b); ++n) {
        double z[kChannels];
        LoadOutput(output, n, z);
        sum += log_.Cost(*log, n) + chromaticity_.Cost(b * kBatch + n, z);
      }
      return sum;
    });
    return cost + energy_.Cost(w.data());
  }

  bool Gradient(const double* weights, double* cost, double* gradient) override {
    const AlignedVector<T> w = Converted(weights);
    Linearization at;  // its hessian stays empty
    at.gradient.assign(shape_.num_weights(), 0.0);
    AddGradient(w.data(), all_batches_, &at);
    energy_.Linearize(w.data(), &at);
    *cost = at.cost;
    std::copy(at.gradient.begin(), at.gradient.end(), gradient);
    return IsFinite(at);
  }

  double MeanAbsLogError(const double* weights) override {
    const double sum = Sum(Converted(weights), [&](std::size_t b, T* output, LogTerm::Batch* log) {
      for (int k = 0; k < kChannels * kBatch; ++k) output[k] = std::max(output[k], T(0));
      log_.Evaluate(b, output, log);
      double batch_sum = 0.0;
      for (int n = 0; n < inputs_.batch_size(b); ++n) {
        for (int c = 0; c < kChannels; ++c) batch_sum += std::abs(log->residuals[c * kBatch + n]);
      }
      return batch_sum;
    });
    return sum / static_cast<double>(kChannels * inputs_.size());
  }

  const EnergyWork& energy_work() const override { return energy_.work(); }

  using Objective::Linearize;
  bool Linearize(const double* weights, CurvaturePart part, Linearization* at) override {
    const AlignedVector<T> w = Converted(weights);
    const Split split = SplitBatches(part);
    at->cost = 0.0;
    at->gradient.assign(shape_.num_weights(), 0.0);
    at->hessian.assign(at->gradient.size() * at->gradient.size(), 0.0);
    AddCurvature(w.data(), split.curved, at);
    const double scale = static_cast<double>(inputs_.size()) / split.curved_samples;
    if (scale != 1.0) {
      for (double& entry : at->hessian) entry *= scale;
    }
    AddGradient(w.data(), split.rest, at);
    energy_.Linearize(w.data(), at);
    return IsFinite(*at);
  }

 private:
  // A partial sum of J'J, J'r and the cost.
  struct CurvatureWorker {
    CurvatureWorker(const NetworkShape& shape, int rows)
        : mlp(shape, rows), residuals(rows * kBatch), sums(shape) {}
    BatchedMlp<T> mlp;
    AlignedVector<T> residuals;  // row after row
    NormalEquations<T> sums;
    LogTerm::Batch log;
    double cost = 0.0;
  };

  // Of J'r and the cost: the rows of a sample are summed, times their residuals, before they go
  // backward.
  struct GradientWorker {
    explicit GradientWorker(const NetworkShape& shape)
        : mlp(shape, 1), batch_sum(shape.num_weights()), sum(shape.num_weights()) {}
    BatchedMlp<T> mlp;
    AlignedVector<T> batch_sum;
    std::vector<double> sum;
    LogTerm::Batch log;
    double cost = 0.0;
  };

  using Batches = std::vector<std::size_t>;

  struct Split {
    Batches curved, rest;
    double curved_samples = 0.0;
  };

  Split SplitBatches(CurvaturePart part) const {
    part.count = std::clamp<std::size_t>(part.count, 1, all_batches_.size());
    Split split;
    for (std::size_t b : all_batches_) {
      const bool curved = b % part.count == part.index % part.count;
      (curved ? split.curved : split.rest).push_back(b);
      if (curved) split.curved_samples += inputs_.batch_size(b);
    }
    return split;
  }

  // Adds cost, J'r and J'J of some batches, at least one.
  void AddCurvature(const T* w, const Batches& batches, Linearization* at) {
    const std::size_t partitions = PartitionCount(batches.size());
    while (curvature_workers_.size() < partitions) {
      curvature_workers_.push_back(
          std::make_unique<CurvatureWorker>(shape_, log_.rows() + chromaticity_.rows()));
    }
    tbb::parallel_for(std::size_t{0}, partitions, [&](std::size_t p) {
      CurvatureWorker& worker = *curvature_workers_[p];
      worker.cost = 0.0;
      worker.sums.Clear();
      for (std::size_t i = p; i < batches.size(); i += partitions) {
        LinearizeBatch(w, batches[i], &worker);
      }
    });
    std::vector<const NormalEquations<T>*> others;
    for (std::size_t p = 0; p < partitions; ++p) {
      at->cost += curvature_workers_[p]->cost;
      if (p > 0) others.push_back(&curvature_workers_[p]->sums);
    }
    curvature_workers_[0]->sums.Add(others);
    curvature_workers_[0]->sums.AddTo(at->gradient.data(), at->hessian.data());
  }

  // Adds cost and J'r of some batches.
  void AddGradient(const T* w, const Batches& batches, Linearization* at) {
    const std::size_t partitions = PartitionCount(batches.size());
    while (gradient_workers_.size() < partitions) {
      gradient_workers_.push_back(std::make_unique<GradientWorker>(shape_));
    }
    tbb::parallel_for(std::size_t{0}, partitions, [&](std::size_t p) {
      GradientWorker& worker = *gradient_workers_[p];
      worker.cost = 0.0;
      std::fill(worker.sum.begin(), worker.sum.end(), 0.0);
      for (std::size_t i = p; i < batches.size(); i += partitions) {
        AddGradientOfBatch(w, batches[i], &worker);
      }
    });
    for (std::size_t p = 0; p < partitions; ++p) {
      const GradientWorker& worker = *gradient_workers_[p];
      at->cost += worker.cost;
      for (std::size_t i = 0; i < worker.sum.size(); ++i) at->gradient[i] += worker.sum[i];
    }
  }

  AlignedVector<T> Converted(const double* weights) const {
    return AlignedVector<T>(weights, weights + shape_.num_weights());
  }

  static void LoadOutput(const T* output, int n, double* z) {
    for (int c = 0; c < kChannels; ++c) z[c] = static_cast<double>(output[c * kBatch + n]);
  }

  // The sum over batches of value(batch, outputs by feature, space for the log term).
  template <typename Value>
  double Sum(const AlignedVector<T>& w, Value value) const {
    const std::size_t partitions = PartitionCount(inputs_.num_batches());
    std::vector<double> sums(partitions, 0.0);
    tbb::parallel_for(std::size_t{0}, partitions, [&](std::size_t p) {
      BatchedMlp<T> mlp(shape_, 0);
      LogTerm::Batch log;
      for (std::size_t b = p; b < inputs_.num_batches(); b += partitions) {
        mlp.Forward(w.data(), inputs_.batch(b));
        sums[p] += value(b, mlp.output(), &log);
      }
    });
    double total = 0.0;
    for (double sum : sums) total += sum;
    return total;
  }

  void LinearizeBatch(const T* w, std::size_t b, CurvatureWorker* worker) const {
    BatchedMlp<T>& mlp = worker->mlp;
    mlp.Forward(w, inputs_.batch(b));
    log_.Evaluate(b, mlp.output(), &worker->log);
    const int size = inputs_.batch_size(b);
    if (size < kBatch) ClearRows(worker);
    for (int n = 0; n < size; ++n) {
      double z[kChannels];
      LoadOutput(mlp.output(), n, z);
      const auto set_from = [&](int first_row) {
        return [&, first_row](int row, double residual, const double* gradient) {
          worker->residuals[(first_row + row) * kBatch + n] = static_cast<T>(residual);
          T* to = mlp.output_gradient(first_row + row) + n;
          for (int c = 0; c < kChannels; ++c) to[c * kBatch] = static_cast<T>(gradient[c]);
        };
      };
      const std::size_t sample = b * kBatch + n;
      worker->cost += log_.Linearize(worker->log, n, set_from(0));
      worker->cost += chromaticity_.Linearize(sample, z, set_from(log_.rows()));
    }
    mlp.Backward(w);
    mlp.TransposeInputs();
    worker->sums.AddBatch(mlp, worker->residuals.data());
  }

  void AddGradientOfBatch(const T* w, std::size_t b, GradientWorker* worker) const {
    BatchedMlp<T>& mlp = worker->mlp;
    mlp.Forward(w, inputs_.batch(b));
    log_.Evaluate(b, mlp.output(), &worker->log);
    T* to = mlp.output_gradient(0);
    std::fill(to, to + kChannels * kBatch, T(0));
    for (int n = 0; n < inputs_.batch_size(b); ++n) {
      double z[kChannels], sum[kChannels] = {};
      LoadOutput(mlp.output(), n, z);
      const auto add = [&](int, double residual, const double* gradient) {
        for (int c = 0; c < kChannels; ++c) sum[c] += residual * gradient[c];
      };
      worker->cost += log_.Linearize(worker->log, n, add);
      worker->cost += chromaticity_.Linearize(b * kBatch + n, z, add);
      for (int c = 0; c < kChannels; ++c) to[c * kBatch + n] = static_cast<T>(sum[c]);
    }
    mlp.Backward(w);
    std::fill(worker->batch_sum.begin(), worker->batch_sum.end(), T(0));
    mlp.AddWeightGradient(0, worker->batch_sum.data());
    for (std::size_t i = 0; i < worker->sum.size(); ++i) worker->sum[i] += worker->batch_sum[i];
  }

  // So that the places behind the last sample of a batch add nothing.
  static void ClearRows(CurvatureWorker* worker) {
    std::fill(worker->residuals.begin(), worker->residuals.end(), T(0));
    for (int row = 0; row < worker->mlp.rows(); ++row) {
      T* gradient = worker->mlp.output_gradient(row);
      std::fill(gradient, gradient + kChannels * kBatch, T(0));
    }
  }

  static bool IsFinite(const Linearization& at) {
    // A sum is finite only if all of its terms are, and J'J is if its diagonal is, as |(J'J)_ij| is
    // at most the larger one of (J'J)_ii and (J'J)_jj.
    double sum = at.cost;
    for (double value : at.gradient) sum += 0.0 * value;
    for (std::size_t i = 0; i < at.hessian.size(); i += at.gradient.size() + 1) {
      sum += 0.0 * at.hessian[i];
    }
    return std::isfinite(sum);
  }

  NetworkShape shape_;
  EncodedBatches<T> inputs_;
  LogTerm log_;
  PointTerm<ChromaticityResidual> chromaticity_;
  EnergyTerm<T> energy_;
  std::vector<std::size_t> all_batches_;
  std::vector<std::unique_ptr<CurvatureWorker>> curvature_workers_;  // one a partition
  std::vector<std::unique_ptr<GradientWorker>> gradient_workers_;
};

}  // namespace

std::unique_ptr<Objective> MakeObjective(const FitProblem& problem,
                                         std::span<const BrdfSample> samples,
                                         std::span<const EnergyStratum> strata) {
  if (problem.precision == Precision::kDouble) {
    return std::make_unique<BatchedObjective<double>>(problem, samples, strata);
  }
  return std::make_unique<BatchedObjective<float>>(problem, samples, strata);
}

std::unique_ptr<Objective> MakeObjective(const FitProblem& problem,
                                         std::span<const BrdfSample> samples) {
  return MakeObjective(problem, samples, EqualStrata(problem));
}

}  // namespace pbnbrdf
