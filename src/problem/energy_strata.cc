#include "pbnbrdf/problem/energy_strata.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr int kChannels = NetworkShape::kChannels;
constexpr int kBatch = kernels::kBatch;

}  // namespace

double StratumAngle(int k, int strata) { return std::acos((k + 0.5) / strata); }

template <typename T>
EnergyStrata<T>::EnergyStrata(const FitProblem& problem) : shape_(problem.Shape()) {
  if (problem.energy_weight == 0.0) return;
  const double solid_angle = 2.0 * std::numbers::pi / problem.energy_strata;
  absolute_ = problem.loss == Loss::kAbsolute;
  weight_ = problem.energy_weight * solid_angle / (absolute_ ? kChannels : 1);
  strata_.resize(problem.energy_strata);
  for (int k = 0; k < problem.energy_strata; ++k) {
    const auto nodes = AlbedoQuadrature(StratumAngle(k, problem.energy_strata),
                                        problem.energy_theta, problem.energy_phi);
    for (const AlbedoNode& node : nodes) {
      strata_[k].inputs.Add(Encode(shape_.encoding(), node.pair));
      strata_[k].node_weights.push_back(node.weight);
    }
  }
}

template <typename T>
std::vector<Rgb> EnergyStrata<T>::Albedos(const T* weights) const {
  std::vector<Rgb> albedos(strata_.size());
  tbb::parallel_for(std::size_t{0}, strata_.size(),
                    [&](std::size_t k) { albedos[k] = Albedo(weights, strata_[k]); });
  return albedos;
}

template <typename T>
double EnergyStrata<T>::Cost(const T* weights) const {
  double cost = 0.0;
  for (const Rgb& albedo : Albedos(weights)) {
    for (double a : albedo) cost += CostOf(std::max(0.0, a - 1.0));
  }
  return cost;
}

template <typename T>
void EnergyStrata<T>::Linearize(const T* weights, Linearization* at) const {
  const std::vector<Rgb> albedos = Albedos(weights);
  std::vector<std::size_t> active;
  for (std::size_t k = 0; k < albedos.size(); ++k) {
    const Rgb& a = albedos[k];
    if (!(std::max({a[0], a[1], a[2]}) <= 1.0)) active.push_back(k);
  }
  if (active.empty()) return;
  // The rows of J: a stratum and a channel each.
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int p = shape_.num_weights();
  RowMajor jacobian = RowMajor::Zero(kChannels * active.size(), p);  // of the albedos
  Eigen::VectorXd slopes(jacobian.rows());
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t k) {
    AlbedoGradients(weights, strata_[active[k]], jacobian.row(kChannels * k).data());
  });
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    const double excess = albedos[active[row / kChannels]][row % kChannels] - 1.0;
    at->cost += CostOf(std::max(0.0, excess));
    slopes[row] = SlopeOf(std::max(0.0, excess));
    if (!(excess > 0.0)) jacobian.row(row).setZero();
  }
  Eigen::Map<Eigen::VectorXd>(at->gradient.data(), p) += jacobian.transpose() * slopes;
  if (at->hessian.empty()) return;
  Eigen::Map<RowMajor>(at->hessian.data(), p, p) += weight_ * (jacobian.transpose() * jacobian);
}

template <typename T>
double EnergyStrata<T>::CostOf(double excess) const {
  return absolute_ ? weight_ * excess : 0.5 * weight_ * excess * excess;
}

template <typename T>
double EnergyStrata<T>::SlopeOf(double excess) const {
  return absolute_ ? weight_ : weight_ * excess;
}

template <typename T>
Rgb EnergyStrata<T>::Albedo(const T* weights, const Stratum& stratum) const {
  BatchedMlp<T> mlp(shape_, 0);
  Rgb albedo = {};
  for (std::size_t b = 0; b < stratum.inputs.num_batches(); ++b) {
    mlp.Forward(weights, stratum.inputs.batch(b));
    for (int c = 0; c < kChannels; ++c) {
      for (int n = 0; n < stratum.inputs.batch_size(b); ++n) {
        const double z = static_cast<double>(mlp.output()[c * kBatch + n]);
        if (!(z <= 0.0)) albedo[c] += stratum.node_weights[b * kBatch + n] * Reflectance(z);
      }
    }
  }
  return albedo;
}

// gradients: kChannels x P, row-major, zero on entry: d albedo_c / d weights.
template <typename T>
void EnergyStrata<T>::AlbedoGradients(const T* weights, const Stratum& stratum,
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

template class EnergyStrata<float>;
template class EnergyStrata<double>;

}  // namespace pbnbrdf
