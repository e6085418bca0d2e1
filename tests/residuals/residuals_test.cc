// Each term: the formula of its equation, and its gradient through the whole network against
// numeric differences (Ridders' method, ceres::GradientChecker).
#include <ceres/autodiff_cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <ceres/gradient_checker.h>

#include "brdf/direction_pairs.h"
#include "network/random_network.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "pbnbrdf/residuals/energy_residual.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "pbnbrdf/residuals/network_residual.h"

namespace pbnbrdf {
namespace {

constexpr Rgb kValue = {0.3, 2.0, 40.0};
constexpr double kCos = 0.6;

std::array<double, kEncodedSize> EncodedPair(const NetworkShape& shape, unsigned seed) {
  return Encode(shape.encoding(), RandomPairs(1, seed)[0]);
}

// "" if the derivatives agree to 1e-6, otherwise the checker's table.
std::string JacobianErrors(const ceres::CostFunction& cost, const NetworkShape& shape,
                           std::vector<double> weights) {
  ceres::NumericDiffOptions numeric;
  numeric.ridders_relative_initial_step_size = 1e-3;  // the default, 1e-2, gives false alarms
  const std::vector<const ceres::Manifold*> euclidean(shape.num_layers(), nullptr);
  const ceres::GradientChecker checker(&cost, &euclidean, numeric);
  const std::vector<double*> blocks = shape.Blocks(weights.data());
  ceres::GradientChecker::ProbeResults results;
  return checker.Probe(blocks.data(), 1e-6, &results) ? "" : results.error_log + "differs";
}

template <typename Term>
std::unique_ptr<ceres::CostFunction> Dynamic(const NetworkShape& shape,
                                             std::vector<typename NetworkResidual<Term>::Input> in,
                                             Term term) {
  auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<NetworkResidual<Term>, 8>>(
      new NetworkResidual<Term>(shape, std::move(in), std::move(term)));
  for (int l = 0; l < shape.num_layers(); ++l) cost->AddParameterBlock(shape.block_size(l));
  cost->SetNumResiduals(Term::kNumResiduals);
  return cost;
}

EnergyResidual MakeEnergy(const NetworkShape& shape,
                          std::vector<NetworkResidual<EnergyResidual>::Input>* inputs) {
  std::vector<double> node_weights;
  for (const AlbedoNode& node : AlbedoQuadrature(6, 4).Nodes(FromSpherical(0.5, 0.0))) {
    inputs->push_back(Encode(shape.encoding(), node.pair));
    node_weights.push_back(node.weight);
  }
  return EnergyResidual(/*solid_angle=*/0.4, node_weights);
}

TEST(LogResidual, IsEquation6) {
  const double z[3] = {0.5, -0.2, 3.0};
  double r[3];
  LogResidual(kValue, kCos)(z, r);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(r[c], std::log(1 + kValue[c] * kCos) - std::log(1 + (std::exp(z[c]) - 1) * kCos),
                1e-14);
  }
}

TEST(ChromaticityResidual, IsEquation7) {
  const double z[3] = {0.5, -0.2, 3.0};
  double r, norm = 0.0, norm_fit = 0.0;
  ChromaticityResidual(kValue, kCos)(z, &r);
  for (int c = 0; c < 3; ++c) {
    norm += std::pow(kValue[c] * kCos, 2);
    norm_fit += std::pow((std::exp(z[c]) - 1) * kCos, 2);
  }
  EXPECT_NEAR(r, std::log(1 + norm) - std::log(1 + norm_fit), 1e-14);
}

TEST(EnergyResidual, IsEquation5OfAStratum) {
  const EnergyResidual energy(/*solid_angle=*/0.25, {1.0, 2.0});
  // Albedos: 1 * 0.5 + 2 * 0.75 = 2, clamped 0 + 2 * 0.25, below 1.
  const double z[6] = {std::log1p(0.5), -1.0, 0.1, std::log1p(0.75), std::log1p(0.25), 0.1};
  double r[3];
  energy(z, r);
  EXPECT_NEAR(r[0], 0.5 * (2.0 - 1.0), 1e-14);
  EXPECT_EQ(r[1], 0.0);
  EXPECT_EQ(r[2], 0.0);
}

class ResidualGradients : public testing::TestWithParam<std::tuple<Encoding, unsigned>> {
 protected:
  NetworkShape shape_{std::get<0>(GetParam()), {5, 4}, Activation::kTanh};
  unsigned seed_ = std::get<1>(GetParam());
  std::vector<double> weights_ = RandomWeights(shape_, 0.8, seed_);
};

TEST_P(ResidualGradients, LogMatchesRidders) {
  const auto cost = Dynamic(shape_, {EncodedPair(shape_, seed_)}, LogResidual(kValue, kCos));
  EXPECT_EQ(JacobianErrors(*cost, shape_, weights_), "");
}

TEST_P(ResidualGradients, ChromaticityMatchesRidders) {
  const auto cost =
      Dynamic(shape_, {EncodedPair(shape_, seed_)}, ChromaticityResidual(kValue, kCos));
  EXPECT_EQ(JacobianErrors(*cost, shape_, weights_), "");
}

TEST_P(ResidualGradients, EnergyMatchesRidders) {
  // Outputs all positive, albedos above 1: numeric differences must not step across a clamp.
  for (int c = 1; c <= 3; ++c) weights_[shape_.offset(2) + 5 * c - 1] = 4.0;
  std::vector<NetworkResidual<EnergyResidual>::Input> inputs;
  const EnergyResidual energy = MakeEnergy(shape_, &inputs);
  const auto cost = Dynamic(shape_, inputs, energy);
  const std::vector<double*> blocks = shape_.Blocks(weights_.data());
  double residuals[3];
  ASSERT_TRUE(cost->Evaluate(blocks.data(), residuals, nullptr));
  for (double r : residuals) EXPECT_GT(r, 0.0);
  EXPECT_EQ(JacobianErrors(*cost, shape_, weights_), "");
}

INSTANTIATE_TEST_SUITE_P(Points, ResidualGradients,
                         testing::Combine(testing::Values(Encoding::kCartesian,
                                                          Encoding::kReciprocal,
                                                          Encoding::kMultiscale),
                                          testing::Range(1u, 6u)));

// The published network through ceres::AutoDiffCostFunction, sizes known when compiled.
TEST(NetworkResidual, StaticAutodiffOfThe675Weights) {
  const NetworkShape shape(Encoding::kReciprocal, {21, 21}, Activation::kTanh);
  const std::vector<double> weights = RandomWeights(shape, 0.3, /*seed=*/1);
  using Functor = NetworkResidual<LogResidual>;
  const ceres::AutoDiffCostFunction<Functor, 3, 147, 462, 66> cost(
      new Functor(shape, {EncodedPair(shape, 1)}, LogResidual(kValue, kCos)));
  EXPECT_EQ(JacobianErrors(cost, shape, weights), "");
}

// A log residual whose derivative has the wrong sign in one weight: the check must say so.
class FlippedSign final : public ceres::CostFunction {
 public:
  explicit FlippedSign(const NetworkShape& shape)
      : cost_(Dynamic(shape, {EncodedPair(shape, 1)}, LogResidual(kValue, kCos))) {
    *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
    set_num_residuals(cost_->num_residuals());
  }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (!cost_->Evaluate(parameters, residuals, jacobians)) return false;
    if (jacobians != nullptr && jacobians[1] != nullptr) jacobians[1][0] *= -1.0;
    return true;
  }

 private:
  std::unique_ptr<ceres::CostFunction> cost_;
};

TEST(JacobianErrors, CatchesAFlippedSign) {
  const NetworkShape shape(Encoding::kReciprocal, {5, 4}, Activation::kTanh);
  EXPECT_NE(JacobianErrors(FlippedSign(shape), shape, RandomWeights(shape, 0.8, 1)), "");
}

TEST(NetworkResidual, RefusesToOverflow) {
  const NetworkShape shape(Encoding::kReciprocal, {5, 4}, Activation::kRelu);
  std::vector<double> weights = RandomWeights(shape, 1.0, /*seed=*/1);
  weights.back() = 1e4;  // expm1(1e4) is infinite
  const auto cost = Dynamic(shape, {EncodedPair(shape, 1)}, LogResidual(kValue, kCos));
  double residuals[3];
  EXPECT_FALSE(cost->Evaluate(shape.Blocks(weights.data()).data(), residuals, nullptr));
}

}  // namespace
}  // namespace pbnbrdf
