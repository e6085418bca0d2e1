#include "solve/energy_correction.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/pi.h"
#include "kernels/cholesky.h"
#include "network/batched_mlp.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr AlbedoGrid kGrid = {
    .angles = 160, .tolerance = 1e-5, .excess_tolerance = 0.1, .n_phi = 64};
constexpr double kMinStep = 1e-7;  // of log(1 + f)
constexpr double kWatched = 0.03;  // of an albedo below the target, that a step may raise above it
constexpr int kMaxProfiles = 30, kMaxSteps = 60, kMaxNewtonSteps = 50;
// After so many steps the whole channel is lowered. Fits that end by time need up to 10 steps.
constexpr int kLocalSteps = 24, kLocalRounds = 8;
constexpr double kRidge = 1e-6;  // of the mean square of the features
constexpr double kMaxZ = 30.0;   // where the output is clamped (expressions-inl.h)

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A channel at some directions: log(1 + f) = features * (the channel's last weights).
struct Rows {
  MatrixXd features;  // a row for each pair: the last layer's inputs, and 1 for the bias
  VectorXd z;         // log(1 + f)
};

Rows RowsAt(const NetworkShape& shape, const std::vector<double>& weights,
            const std::vector<DirectionPair>& pairs, int channel) {
  constexpr int kBatch = kernels::kBatch;
  const int last = shape.num_layers() - 1, size = shape.in(last) + 1,
            stride = kernels::Padded(size);
  BatchedMlp<double> mlp(shape, 1);
  AlignedVector<double> input(kEncodedSize * kBatch);
  Rows rows = {MatrixXd(pairs.size(), size), VectorXd(pairs.size())};
  for (std::size_t first = 0; first < pairs.size(); first += kBatch) {
    const std::size_t count = std::min<std::size_t>(kBatch, pairs.size() - first);
    for (std::size_t n = 0; n < count; ++n) {
      const auto encoded = Encode(shape.encoding(), pairs[first + n]);
      for (int i = 0; i < kEncodedSize; ++i) input[i * kBatch + n] = encoded[i];
    }
    mlp.Forward(weights.data(), input.data());
    mlp.TransposeInputs();
    for (std::size_t n = 0; n < count; ++n) {
      const auto row = static_cast<Eigen::Index>(first + n);
      rows.features.row(row) =
          Eigen::Map<const Eigen::RowVectorXd>(mlp.layer_input(last) + n * stride, size);
      rows.z[row] = std::min(mlp.output()[channel * kBatch + n], kMaxZ);
    }
  }
  return rows;
}

// Pairs at uniform angles, all of them different: the additive recurrence of the four-dimensional golden
// ratio. On a grid the correction would hide between its nodes.
std::vector<DirectionPair> TypicalPairs(bool isotropic) {
  constexpr int kCount = 2048;
  constexpr double kSteps[] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                               0.5385972572236101};
  std::vector<DirectionPair> pairs;
  for (int n = 1; n <= kCount; ++n) {
    const auto u = [&](int k) { return std::fmod(n * kSteps[k], 1.0); };
    pairs.push_back(FromAngles({.theta_h = 0.5 * kPi * u(0),
                                .theta_d = 0.5 * kPi * u(1),
                                .phi_d = kPi * u(2),
                                .phi_h = isotropic ? 0.0 : 2.0 * kPi * u(3)}));
  }
  return pairs;
}

// How far to go along `direction` of the last weights, so that an albedo that was measured to be
// `albedo` becomes `bound`. Newton's method on a convex function: its steps don't go too far.
double StepTo(const Rows& rows, const std::vector<AlbedoNode>& nodes, const VectorXd& direction,
              double albedo, double bound) {
  const VectorXd slopes = rows.features * direction;
  double step = 0.0, target = 0.0;
  for (int k = 0; k < kMaxNewtonSteps; ++k) {
    double sum = 0.0, slope = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const auto row = static_cast<Eigen::Index>(n);
      const double z = rows.z[row] - step * slopes[row];
      if (!(z > 0.0)) continue;
      sum += nodes[n].weight * std::expm1(z);
      slope += nodes[n].weight * std::exp(z) * slopes[row];
    }
    if (k == 0)
      target = sum * bound / albedo;  // these nodes aren't those that it was measured with
    if (!(sum > target) || !(slope > 0.0)) break;
    step += (sum - target) / slope;
  }
  return step;
}

// What a channel's albedo gains as its last weights grow.
VectorXd AlbedoGradient(const Rows& rows, const std::vector<AlbedoNode>& nodes) {
  VectorXd gradient = VectorXd::Zero(rows.features.cols());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    if (!(rows.z[row] > 0.0)) continue;
    gradient += nodes[n].weight * std::exp(rows.z[row]) * rows.features.row(row).transpose();
  }
  return gradient;
}

// What a change of a channel's last weights does to log(1 + f) at typical pairs. The features there are
// those of the layers before, which stay.
class TypicalChange {
 public:
  TypicalChange(const NetworkShape& shape, const std::vector<double>& weights)
      : features_(RowsAt(shape, weights, TypicalPairs(IsIsotropic(shape.encoding())), 0).features),
        squares_(static_cast<int>(features_.cols())) {
    const double ridge = kRidge * features_.squaredNorm() / squares_.size();
    for (int i = 0; i < squares_.size(); ++i) {
      for (int j = 0; j <= i; ++j) squares_.row(i)[j] = features_.col(i).dot(features_.col(j));
      squares_.row(i)[i] += ridge;
    }
    squares_.Factor();  // always positive definite, with the ridge
  }

  // The direction that changes log(1 + f) least, in the mean square, for what it gains along the gradient.
  VectorXd Cheapest(const VectorXd& gradient) const {
    VectorXd direction = gradient / gradient.norm();
    squares_.Solve(direction.data());
    return direction;
  }

  double MeanAbs(const VectorXd& change) const { return (features_ * change).cwiseAbs().mean(); }

 private:
  MatrixXd features_;
  Cholesky squares_;  // of features' * features
};

class Corrector {
 public:
  Corrector(const NetworkShape& shape, const std::function<bool()>& has_time,
            std::vector<double>* weights)
      : shape_(shape),
        has_time_(has_time),
        weights_(weights),
        typical_(shape, *weights),
        before_(*weights) {}

  Correction Run() {
    double largest = 0.0;
    std::vector<IncidentAlbedo> profile;
    // In single precision until nothing is left to do; then as exactly as a check.
    for (bool exactly : {false, true}) {
      for (int k = 0; k < kMaxProfiles; ++k) {
        profile = Profile(exactly);
        largest = Largest(LargestAlbedos(profile));
        if (!(largest > kMaxAlbedo)) break;
        LowerAll(profile, k);
      }
    }
    return {MeanChange(), largest, std::move(profile)};
  }

 private:
  // The directions whose albedos may matter, as the profile has them and by a quadrature of fewer nodes.
  struct Watched {
    std::vector<IncidentAlbedo> at;
    std::vector<Rgb> own;
  };

  std::vector<IncidentAlbedo> Profile(bool exactly) const {
    const NeuralBrdf exact(shape_, *weights_);
    if (exactly) return AlbedoProfile(exact, {});  // as MeasureEnergy does
    return AlbedoProfile(*exact.SinglePrecision(), kGrid);
  }

  // Lowers the largest albedo again and again. In between only the large ones are measured anew.
  void LowerAll(const std::vector<IncidentAlbedo>& profile, int number) {
    Watched watched;
    for (const IncidentAlbedo& at : profile) {
      if (Largest(at.albedo) > kTargetAlbedo - kWatched) watched.at.push_back(at);
    }
    watched.own.resize(watched.at.size());
    Measure(&watched, /*anew=*/false);
    const bool locally = number == 0 || (number < kLocalRounds && has_time_());
    for (int step = 0; step < kMaxSteps; ++step) {
      bool lowered = false;
      for (int c = 0; c < shape_.num_outputs(); ++c) {
        lowered |= LowerLargest(watched.at, c, number, locally && step < kLocalSteps);
      }
      if (!lowered) return;
      Measure(&watched, /*anew=*/true);
    }
  }

  // By the quadrature of fewer nodes; anew: what has changed by it is applied to the albedos.
  void Measure(Watched* watched, bool anew) const {
    const std::unique_ptr<Brdf> network = NeuralBrdf(shape_, *weights_).SinglePrecision();
    ParallelFor(watched->at.size(), [&](std::size_t k) {
      IncidentAlbedo& at = watched->at[k];
      const Vec3 wi = FromSpherical(at.theta_i, at.phi_i);
      const Rgb own = DirectionalAlbedo(*network, wi, quadrature_);
      for (int c = 0; c < 3 && anew; ++c) at.albedo[c] *= own[c] / watched->own[k][c];
      watched->own[k] = own;
    });
  }

  // false if it isn't above the target.
  bool LowerLargest(const std::vector<IncidentAlbedo>& watched, int channel, int number,
                    bool locally) {
    const IncidentAlbedo& there = LargestIn(watched, channel);
    const double albedo = there.albedo[channel];
    if (!(albedo > kTargetAlbedo)) return false;
    const std::vector<AlbedoNode> nodes =
        quadrature_.Nodes(FromSpherical(there.theta_i, there.phi_i));
    std::vector<DirectionPair> pairs;
    for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
    const Rows rows = RowsAt(shape_, *weights_, pairs, channel);
    VectorXd direction = VectorXd::Unit(rows.features.cols(), rows.features.cols() - 1);
    if (locally) direction = typical_.Cheapest(AlbedoGradient(rows, nodes));
    double step = StepTo(rows, nodes, direction, albedo, kTargetAlbedo * (1.0 - kMinStep));
    if (!locally) step += std::ldexp(kMinStep, number);  // more and more, if it goes on
    LastWeights(weights_, channel) -= step * direction;
    return true;
  }

  Eigen::Map<VectorXd> LastWeights(std::vector<double>* weights, int channel) const {
    const int last = shape_.num_layers() - 1, size = shape_.in(last) + 1;
    return {weights->data() + shape_.offset(last) + channel * size, size};
  }

  double MeanChange() {
    double largest = 0.0;
    for (int c = 0; c < shape_.num_outputs(); ++c) {
      largest =
          std::max(largest, typical_.MeanAbs(LastWeights(weights_, c) - LastWeights(&before_, c)));
    }
    return largest;
  }

  const NetworkShape& shape_;
  const std::function<bool()>& has_time_;
  std::vector<double>* weights_;
  const AlbedoQuadrature quadrature_ = AlbedoQuadrature::OnMerlRows(2, 96);
  const TypicalChange typical_;
  std::vector<double> before_;
};

}  // namespace

Correction LowerToConserve(const NetworkShape& shape, const std::function<bool()>& has_time,
                           std::vector<double>* weights) {
  return Corrector(shape, has_time, weights).Run();
}

}  // namespace pbnbrdf
