#include "pbnbrdf/problem/objective.h"

#include <ceres/jet.h>
#include <ceres/loss_function.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>

#include "pbnbrdf/network/batched_mlp.h"
#include "pbnbrdf/network/encoded_batches.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/problem/normal_equations.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"

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

// sum of rho(s) of one sample's residuals of a term, and the scale sqrt(weight rho'(s)) of its
// rows.
struct RobustWeight {
  double cost, row_scale;
};

RobustWeight Robustify(const ceres::LossFunction* loss, double weight, double squared_norm) {
  double rho[3] = {squared_norm, 1.0, 0.0};
  if (loss != nullptr) loss->Evaluate(squared_norm, rho);
  return {0.5 * weight * rho[0], std::sqrt(weight * rho[1])};
}

double Sign(double x) { return (x > 0.0) - (x < 0.0); }

// A term at the training samples: residuals of Term, which takes the outputs of one sample.
template <typename Term>
class PointTerm {
 public:
  static constexpr int kRows = Term::kNumResiduals;

  // weight: of the mean over the samples; 0 makes it an absent term, without rows.
  PointTerm(double weight, const FitProblem& problem, std::span<const BrdfSample> samples)
      : weight_(weight / static_cast<double>(samples.size())),
        absolute_(problem.loss == Loss::kAbsolute),
        loss_(MakeLoss(problem.loss, problem.loss_scale)) {
    if (weight == 0.0) return;
    residuals_.reserve(samples.size());
    for (const BrdfSample& s : samples) residuals_.emplace_back(s.value, CosI(s.pair));
  }

  int rows() const { return weight_ > 0.0 ? kRows : 0; }

  double Cost(std::size_t sample, const double* z) const {
    if (weight_ == 0.0) return 0.0;
    double r[kRows];
    residuals_[sample](z, r);
    double squared_norm = 0.0, absolute_sum = 0.0;
    for (double value : r) {
      squared_norm += value * value;
      absolute_sum += std::abs(value);
    }
    if (absolute_) return weight_ / kRows * absolute_sum;
    return Robustify(loss_.get(), weight_, squared_norm).cost;
  }

  // Calls set(row, residual, gradient with respect to z) for each row. Returns the cost.
  template <typename SetRow>
  double Linearize(std::size_t sample, const double* z, SetRow set) const {
    if (weight_ == 0.0) return 0.0;
    using Jet = ceres::Jet<double, kChannels>;
    Jet outputs[kChannels], r[kRows];
    for (int c = 0; c < kChannels; ++c) outputs[c] = Jet(z[c], c);
    residuals_[sample](outputs, r);
    if (absolute_) return SetSigns(r, set);
    double squared_norm = 0.0;
    for (const Jet& value : r) squared_norm += value.a * value.a;
    const RobustWeight robust = Robustify(loss_.get(), weight_, squared_norm);
    for (int row = 0; row < kRows; ++row) {
      const Eigen::Vector3d gradient = robust.row_scale * r[row].v;
      set(row, robust.row_scale * r[row].a, gradient.data());
    }
    return robust.cost;
  }

 private:
  // The sum of absolute values has the gradient of a sum of products with the signs.
  template <typename Jet, typename SetRow>
  double SetSigns(const Jet* r, SetRow set) const {
    double sum = 0.0;
    for (int row = 0; row < kRows; ++row) {
      set(row, weight_ / kRows * Sign(r[row].a), r[row].v.data());
      sum += std::abs(r[row].a);
    }
    return weight_ / kRows * sum;
  }

  double weight_;
  bool absolute_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::vector<Term> residuals_;  // one a sample
};

// The log term, a batch at a time: LogResidual and its derivative, vectorised.
class LogTerm {
 public:
  // Residuals and slopes d r_c / d z_c of a batch, by feature.
  struct Batch {
    AlignedVector<double> residuals = AlignedVector<double>(kChannels * kBatch);
    AlignedVector<double> slopes = AlignedVector<double>(kChannels * kBatch);
  };

  // weight: of the mean over the samples; 0 makes it an absent term, without rows.
  LogTerm(double weight, const FitProblem& problem, std::span<const BrdfSample> samples)
      : weight_(weight / static_cast<double>(samples.size())),
        absolute_(problem.loss == Loss::kAbsolute),
        loss_(MakeLoss(problem.loss, problem.loss_scale)) {
    const std::size_t padded = (samples.size() + kBatch - 1) / kBatch * kBatch;
    cos_i_.resize(padded);
    targets_.resize(kChannels * padded);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      cos_i_[n] = CosI(samples[n].pair);
      double* target = &targets_[n / kBatch * kChannels * kBatch + n % kBatch];
      for (int c = 0; c < kChannels; ++c) {
        target[c * kBatch] = std::log1p(samples[n].value[c] * cos_i_[n]);
      }
    }
  }

  int rows() const { return weight_ > 0.0 ? kChannels : 0; }

  // z: the outputs at batch b, by feature.
  template <typename T>
  void Evaluate(std::size_t b, const T* z, Batch* batch) const {
    kernels::LogResiduals(z, &targets_[b * kChannels * kBatch], &cos_i_[b * kBatch],
                          batch->residuals.data(), batch->slopes.data());
  }

  double Cost(const Batch& batch, int n) const {
    if (weight_ == 0.0) return 0.0;
    return absolute_ ? AbsoluteSum(batch, n) : Robust(batch, n).cost;
  }

  // Calls set(row, residual, gradient with respect to z) for each row of the batch's sample n.
  // Returns the cost.
  template <typename SetRow>
  double Linearize(const Batch& batch, int n, SetRow set) const {
    if (weight_ == 0.0) return 0.0;
    const RobustWeight robust = absolute_ ? RobustWeight{AbsoluteSum(batch, n), 1.0}
                                          : Robust(batch, n);
    for (int c = 0; c < kChannels; ++c) {
      const double r = batch.residuals[c * kBatch + n];
      double gradient[kChannels] = {};
      gradient[c] = robust.row_scale * batch.slopes[c * kBatch + n];
      set(c, absolute_ ? weight_ / kChannels * Sign(r) : robust.row_scale * r, gradient);
    }
    return robust.cost;
  }

 private:
  double AbsoluteSum(const Batch& batch, int n) const {
    double sum = 0.0;
    for (int c = 0; c < kChannels; ++c) sum += std::abs(batch.residuals[c * kBatch + n]);
    return weight_ / kChannels * sum;
  }

  RobustWeight Robust(const Batch& batch, int n) const {
    double squared_norm = 0.0;
    for (int c = 0; c < kChannels; ++c) {
      const double r = batch.residuals[c * kBatch + n];
      squared_norm += r * r;
    }
    return Robustify(loss_.get(), weight_, squared_norm);
  }

  double weight_;
  bool absolute_;
  std::unique_ptr<ceres::LossFunction> loss_;
  AlignedVector<double> cos_i_;    // batch after batch
  AlignedVector<double> targets_;  // log1p(f cos_i), batch after batch, each by feature
};

template <typename T>
class BatchedObjective final : public Objective {
 public:
  BatchedObjective(const FitProblem& problem, std::span<const BrdfSample> samples)
      : shape_(problem.Shape()),
        log_(problem.log_weight, problem, samples),
        chromaticity_(problem.chromaticity_weight, problem, samples),
        energy_(problem) {
    inputs_.Reserve(samples.size());
    for (const BrdfSample& s : samples) inputs_.Add(Encode(shape_.encoding(), s.pair));
  }

  const NetworkShape& shape() const override { return shape_; }

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
    const std::size_t partitions = PartitionCount(inputs_.num_batches());
    while (gradient_workers_.size() < partitions) {
      gradient_workers_.push_back(std::make_unique<GradientWorker>(shape_));
    }
    tbb::parallel_for(std::size_t{0}, partitions, [&](std::size_t p) {
      GradientWorker& worker = *gradient_workers_[p];
      worker.cost = 0.0;
      std::fill(worker.sum.begin(), worker.sum.end(), 0.0);
      for (std::size_t b = p; b < inputs_.num_batches(); b += partitions) {
        AddGradientOfBatch(w.data(), b, &worker);
      }
    });
    Linearization at;  // its hessian stays empty
    at.gradient.assign(shape_.num_weights(), 0.0);
    for (std::size_t p = 0; p < partitions; ++p) {
      at.cost += gradient_workers_[p]->cost;
      for (int i = 0; i < shape_.num_weights(); ++i) at.gradient[i] += gradient_workers_[p]->sum[i];
    }
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

  bool Linearize(const double* weights, Linearization* at) override {
    const AlignedVector<T> w = Converted(weights);
    const std::size_t partitions = PartitionCount(inputs_.num_batches());
    while (workers_.size() < partitions) {
      workers_.push_back(std::make_unique<Worker>(shape_, log_.rows() + chromaticity_.rows()));
    }
    tbb::parallel_for(std::size_t{0}, partitions, [&](std::size_t p) {
      Worker& worker = *workers_[p];
      worker.cost = 0.0;
      worker.sums.Clear();
      for (std::size_t b = p; b < inputs_.num_batches(); b += partitions) {
        LinearizeBatch(w.data(), b, &worker);
      }
    });
    at->cost = 0.0;
    at->gradient.assign(shape_.num_weights(), 0.0);
    at->hessian.assign(at->gradient.size() * at->gradient.size(), 0.0);
    std::vector<const NormalEquations<T>*> others;
    for (std::size_t p = 0; p < partitions; ++p) {
      at->cost += workers_[p]->cost;
      if (p > 0) others.push_back(&workers_[p]->sums);
    }
    workers_[0]->sums.Add(others);
    workers_[0]->sums.AddTo(at->gradient.data(), at->hessian.data());
    energy_.Linearize(w.data(), at);
    return IsFinite(*at);
  }

 private:
  struct Worker {
    Worker(const NetworkShape& shape, int rows)
        : mlp(shape, rows), residuals(rows * kBatch), sums(shape) {}
    BatchedMlp<T> mlp;
    AlignedVector<T> residuals;  // row after row
    NormalEquations<T> sums;
    LogTerm::Batch log;
    double cost = 0.0;
  };

  // For J'r the rows of a sample are summed, times their residuals, before they go backward.
  struct GradientWorker {
    explicit GradientWorker(const NetworkShape& shape)
        : mlp(shape, 1), batch_sum(shape.num_weights()), sum(shape.num_weights()) {}
    BatchedMlp<T> mlp;
    AlignedVector<T> batch_sum;
    std::vector<double> sum;
    LogTerm::Batch log;
    double cost = 0.0;
  };

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

  void LinearizeBatch(const T* w, std::size_t b, Worker* worker) const {
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
  static void ClearRows(Worker* worker) {
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
  EnergyStrata<T> energy_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::unique_ptr<GradientWorker>> gradient_workers_;
};

}  // namespace

std::unique_ptr<Objective> MakeObjective(const FitProblem& problem,
                                         std::span<const BrdfSample> samples) {
  if (problem.precision == Precision::kDouble) {
    return std::make_unique<BatchedObjective<double>>(problem, samples);
  }
  return std::make_unique<BatchedObjective<float>>(problem, samples);
}

}  // namespace pbnbrdf
