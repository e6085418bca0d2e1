#include "problem/energy_term.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr int kChannels = NetworkShape::kChannels;
using kernels::kBatch;

bool AnyAbove(const Rgb& values, double bound) {
  return std::any_of(values.begin(), values.end(), [&](double v) { return !(v <= bound); });
}

}  // namespace

template <typename T>
typename EnergyTerm<T>::Stratum EnergyTerm<T>::Encoded(const Vec3& wi, std::size_t k) const {
  Stratum stratum;
  stratum.wi = wi;
  for (const AlbedoNode& node : QuadratureOfStratum(problem_, k).Nodes(wi)) {
    stratum.inputs.Add(Encode(shape_.encoding(), node.pair));
    stratum.node_weights.push_back(node.weight);
  }
  return stratum;
}

template <typename T>
void EnergyTerm<T>::Set(double weight, std::span<const EnergyStratum> strata) {
  weight_ = weight;
  linearizations_ = 0;
  if (weight == 0.0) return;
  strata_.resize(std::min(strata_.size(), strata.size()));
  for (std::size_t k = 0; k < strata.size(); ++k) {
    if (k == strata_.size()) strata_.push_back(Encoded(strata[k].wi, k));
    if (strata_[k].wi != strata[k].wi) strata_[k] = Encoded(strata[k].wi, k);
    strata_[k].weight = weight / (IsAbsolute() ? kChannels : 1) * strata[k].solid_angle;
    strata_[k].limit = strata[k].limit;
    strata_[k].excess = {};
    strata_[k].watched = true;
  }
}

// of_all: else of the watched ones only.
template <typename T>
void EnergyTerm<T>::UpdateExcesses(const T* weights, bool of_all) {
  ParallelFor(strata_.size(), [&](std::size_t k) {
    Stratum& stratum = strata_[k];
    if (!of_all && !stratum.watched) return;
    const Rgb albedo = Albedo(weights, stratum);
    for (int c = 0; c < kChannels; ++c) stratum.excess[c] = albedo[c] - stratum.limit[c];
  });
  for (Stratum& stratum : strata_) {
    const bool computed = of_all || stratum.watched;
    ++(computed ? work_.albedos : work_.albedos_skipped);
    if (of_all) stratum.watched = !problem_.terms.energy_skip || AnyAbove(stratum.excess, -kFar);
  }
}

template <typename T>
double EnergyTerm<T>::Cost(const T* weights) {
  if (weight_ == 0.0) return 0.0;
  UpdateExcesses(weights, /*of_all=*/false);
  double cost = 0.0;
  for (const Stratum& stratum : strata_) cost += CostOf(stratum);
  return cost;
}

template <typename T>
void EnergyTerm<T>::Linearize(const T* weights, Linearization* at) {
  if (weight_ == 0.0) return;
  UpdateExcesses(weights, /*of_all=*/linearizations_++ % kRecheck == 0);
  std::vector<const Stratum*> active;
  for (const Stratum& stratum : strata_) {
    if (AnyAbove(stratum.excess, 0.0)) active.push_back(&stratum);
  }
  work_.jacobians += static_cast<std::int64_t>(active.size());
  work_.jacobians_skipped += static_cast<std::int64_t>(strata_.size() - active.size());
  if (active.empty()) return;
  // The rows of J: a stratum and a channel each.
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int p = shape_.num_weights();
  RowMajor jacobian = RowMajor::Zero(kChannels * active.size(), p);  // of the albedos
  ParallelFor(active.size(), [&](std::size_t k) {
    AlbedoGradients(weights, *active[k], jacobian.row(kChannels * k).data());
  });
  Eigen::VectorXd residuals(jacobian.rows());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    const Stratum& stratum = *active[row / kChannels];
    const double excess = std::max(0.0, stratum.excess[row % kChannels]);
    if (row % kChannels == 0) at->cost += CostOf(stratum);
    const double scale =
        excess > 0.0 ? (IsAbsolute() ? stratum.weight : std::sqrt(stratum.weight)) : 0.0;
    residuals[row] = IsAbsolute() ? 1.0 : scale * excess;
    jacobian.row(row) *= scale;
  }
  Eigen::Map<Eigen::VectorXd>(at->gradient.data(), p) += jacobian.transpose() * residuals;
  if (at->hessian.empty()) return;
  Eigen::Map<RowMajor>(at->hessian.data(), p, p) += jacobian.transpose() * jacobian;
}

template <typename T>
double EnergyTerm<T>::CostOf(const Stratum& stratum) const {
  double cost = 0.0;
  for (double excess : stratum.excess) {
    if (excess <= 0.0) continue;  // NaN counts
    cost += stratum.weight * (IsAbsolute() ? excess : 0.5 * excess * excess);
  }
  return cost;
}

template <typename T>
Rgb EnergyTerm<T>::Albedo(const T* weights, const Stratum& stratum) const {
  BatchedMlp<T> mlp(shape_, 0);
  Rgb albedo = {};
  for (std::size_t b = 0; b < stratum.inputs.num_batches(); ++b) {
    mlp.Forward(weights, stratum.inputs.batch(b));
    for (int c = 0; c < kChannels; ++c) {
      for (int n = 0; n < stratum.inputs.batch_size(b); ++n) {
        const double z = static_cast<double>(mlp.output()[c * kBatch + n]);
        if (z <= 0.0) continue;  // NaN counts
        albedo[c] += stratum.node_weights[b * kBatch + n] * Reflectance(z);
      }
    }
  }
  return albedo;
}

// gradients: kChannels x P, row-major, zero on entry: d albedo_c / d weights.
template <typename T>
void EnergyTerm<T>::AlbedoGradients(const T* weights, const Stratum& stratum,
                                    double* gradients) const {
  BatchedMlp<T> mlp(shape_, kChannels);
  const int p = shape_.num_weights();
  AlignedVector<T> batch_gradient(p);
  for (std::size_t b = 0; b < stratum.inputs.num_batches(); ++b) {
    mlp.Forward(weights, stratum.inputs.batch(b));
    for (int c = 0; c < kChannels; ++c) {
      T* gradient = mlp.output_gradient(c);
      std::fill(gradient, gradient + kChannels * kBatch, T(0));
      for (int n = 0; n < stratum.inputs.batch_size(b); ++n) {
        const double z = static_cast<double>(mlp.output()[c * kBatch + n]);
        const double slope = z > 0.0 ? Reflectance(z) + 1.0 : 0.0;  // of max(0, expm1(z))
        gradient[c * kBatch + n] = static_cast<T>(stratum.node_weights[b * kBatch + n] * slope);
      }
    }
    mlp.Backward(weights);
    for (int c = 0; c < kChannels; ++c) {
      std::fill(batch_gradient.begin(), batch_gradient.end(), T(0));
      mlp.AddWeightGradient(c, batch_gradient.data());
      for (int i = 0; i < p; ++i) gradients[c * p + i] += batch_gradient[i];
    }
  }
}

template class EnergyTerm<float>;
template class EnergyTerm<double>;

}  // namespace pbnbrdf
