#include "solve/energy_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "network/batched_mlp.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr AlbedoGrid kGrid = {.angles = 160, .n_phi = 64};
constexpr double kRounding = 2e-6;  // of an albedo in single precision, as seen
constexpr double kMinStep = 1e-7;   // of log(1 + f)
constexpr int kMaxSteps = 50, kMaxNewtonSteps = 50;
// After so many steps the whole channel is lowered. Fits that end by time need up to 6.
constexpr int kLocalSteps = 16;
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

// Pairs at uniform angles.
std::vector<DirectionPair> TypicalPairs(bool isotropic) {
  constexpr int kSteps = 12;
  std::vector<DirectionPair> pairs;
  for (int h = 0; h < kSteps; ++h) {
    for (int d = 0; d < kSteps; ++d) {
      for (int p = 0; p < kSteps; ++p) {
        const double turn = isotropic ? 0.0 : 2.0 * kPi * ((7 * h + 5 * d + p) % kSteps) / kSteps;
        pairs.push_back(FromAngles({.theta_h = 0.5 * kPi * (h + 0.5) / kSteps,
                                    .theta_d = 0.5 * kPi * (d + 0.5) / kSteps,
                                    .phi_d = kPi * (p + 0.5) / kSteps,
                                    .phi_h = turn}));
      }
    }
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

// The change of log(1 + f) per unit step, whose mean square is least for what it takes off the albedo.
VectorXd CheapestDirection(const Rows& rows, const std::vector<AlbedoNode>& nodes,
                           const Rows& typical) {
  VectorXd gradient = VectorXd::Zero(rows.features.cols());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto row = static_cast<Eigen::Index>(n);
    if (!(rows.z[row] > 0.0)) continue;
    gradient += nodes[n].weight * std::exp(rows.z[row]) * rows.features.row(row).transpose();
  }
  MatrixXd squares = typical.features.transpose() * typical.features;
  squares.diagonal().array() += kRidge * squares.trace() / static_cast<double>(squares.rows());
  return squares.ldlt().solve(gradient / gradient.norm());
}

class Corrector {
 public:
  Corrector(const NetworkShape& shape, std::vector<double>* weights)
      : shape_(shape),
        weights_(weights),
        typical_(TypicalPairs(IsIsotropic(shape.encoding()))),
        before_(*weights) {}

  Correction Run() {
    double largest = 0.0;
    // In single precision until nothing is left to do; then in double.
    for (bool exactly : {false, true}) {
      const double bound = exactly ? kMaxAlbedo : kMaxAlbedo - kRounding;
      for (int k = 0; k < kMaxSteps; ++k) {
        const std::vector<IncidentAlbedo> profile = Profile(exactly);
        largest = Largest(LargestAlbedos(profile));
        if (!(largest > bound)) break;
        for (int c = 0; c < shape_.num_outputs(); ++c) Lower(profile, c, bound, k);
      }
    }
    return {MeanChange(), largest};
  }

 private:
  std::vector<IncidentAlbedo> Profile(bool exactly) const {
    const NeuralBrdf exact(shape_, *weights_);
    if (exactly) return AlbedoProfile(exact, kGrid);
    return AlbedoProfile(*exact.SinglePrecision(), kGrid);
  }

  void Lower(const std::vector<IncidentAlbedo>& profile, int channel, double bound, int number) {
    const IncidentAlbedo& there = *std::max_element(
        profile.begin(), profile.end(),
        [channel](const auto& a, const auto& b) { return a.albedo[channel] < b.albedo[channel]; });
    const double albedo = there.albedo[channel];
    if (!(albedo > bound)) return;
    static const auto quadrature = AlbedoQuadrature::OnMerlRows(2, 128);
    const std::vector<AlbedoNode> nodes =
        quadrature.Nodes(FromSpherical(there.theta_i, there.phi_i));
    std::vector<DirectionPair> pairs;
    for (const AlbedoNode& node : nodes) pairs.push_back(node.pair);
    const Rows rows = RowsAt(shape_, *weights_, pairs, channel);
    VectorXd direction = VectorXd::Unit(rows.features.cols(), rows.features.cols() - 1);
    double more = std::ldexp(kMinStep, number);  // if it goes on and on
    if (number < kLocalSteps) {
      direction = CheapestDirection(rows, nodes, RowsAt(shape_, *weights_, typical_, channel));
      more = 0.0;
    }
    const double step = StepTo(rows, nodes, direction, albedo, bound * (1.0 - kMinStep)) + more;
    const int last = shape_.num_layers() - 1, size = shape_.in(last) + 1;
    double* row = weights_->data() + shape_.offset(last) + channel * size;
    for (int i = 0; i < size; ++i) row[i] -= step * direction[i];
  }

  double MeanChange() const {
    double largest = 0.0;
    for (int c = 0; c < shape_.num_outputs(); ++c) {
      const VectorXd change =
          RowsAt(shape_, *weights_, typical_, c).z - RowsAt(shape_, before_, typical_, c).z;
      largest = std::max(largest, change.cwiseAbs().mean());
    }
    return largest;
  }

  const NetworkShape& shape_;
  std::vector<double>* weights_;
  std::vector<DirectionPair> typical_;
  std::vector<double> before_;
};

}  // namespace

Correction LowerToConserve(const NetworkShape& shape, std::vector<double>* weights) {
  return Corrector(shape, weights).Run();
}

}  // namespace pbnbrdf
