#include "pbnbrdf/proof/energy_proof.h"

#include "network/random_network.h"
#include "pbnbrdf/brdf/albedo.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

// A network of one value, 1/sr, everywhere.
NeuralBrdf Constant(double f, Encoding encoding) {
  const NetworkShape shape(encoding, {2}, Activation::kTanh);
  std::vector<double> weights(std::size_t(shape.num_weights()), 0.0);
  for (int c = 0; c < 3; ++c) weights[weights.size() - 1 - std::size_t(3 * c)] = std::log1p(f);
  return NeuralBrdf(shape, weights);
}

TEST(EnergyProof, OfAConstantIsNearItsAlbedo) {
  for (const Encoding encoding : {Encoding::kMerl, Encoding::kElevations, Encoding::kAnisotropic}) {
    const EnergyProof proof = ProveEnergy(Constant(0.9 / kPi, encoding), {.seconds = 60.0});
    EXPECT_TRUE(proof.IsProved());
    EXPECT_GE(proof.bound, 0.9);
    EXPECT_NEAR(proof.estimate, 0.9, 0.05);
  }
}

TEST(EnergyProof, IsNotGivenToWhatMakesEnergy) {
  const EnergyProof proof = ProveEnergy(Constant(1.01 / kPi, Encoding::kMerl));
  EXPECT_FALSE(proof.IsProved());
  EXPECT_EQ(proof.proved_part, 0.0);
  EXPECT_GE(proof.bound, 1.01);
}

// The largest of the channels, by quadrature.
double Albedo(const NeuralBrdf& network, const Vec3& wi) {
  Rgb sum = {};
  for (const AlbedoNode& node : AlbedoQuadrature::OnMerlRows(3, 64).Nodes(wi)) {
    Rgb f;
    network.Evaluate({&node.pair, 1}, {&f, 1});
    for (std::size_t c = 0; c < 3; ++c) sum[c] += node.weight * f[c];
  }
  return *std::max_element(sum.begin(), sum.end());
}

// However few pieces there are, no albedo is above the bound.
TEST(EnergyProof, BoundsTheAlbedosOfAllEncodings) {
  for (const auto& [name, encoding] : kEncodings) {
    for (const Activation activation : {Activation::kTanh, Activation::kRelu}) {
      const NetworkShape shape(encoding, {4, 3}, activation);
      const NeuralBrdf network(shape, RandomWeights(shape, 0.4, /*seed=*/2));
      const EnergyProof proof = ProveEnergy(network, {.max_pieces = 1});
      double largest = 0.0;
      for (double theta_i : {0.0, 0.4, 0.8, 1.2, 1.5, 1.57}) {
        largest = std::max(largest, Albedo(network, FromSpherical(theta_i, 2.0)));
      }
      EXPECT_GE(proof.bound, largest) << name;
    }
  }
}

// More pieces, a nearer bound.
TEST(EnergyProof, ComesNearerWithMorePieces) {
  const NetworkShape shape(Encoding::kElevations, {3}, Activation::kTanh);
  const NeuralBrdf network(shape, RandomWeights(shape, 0.2, /*seed=*/2));
  const double albedo = Albedo(network, FromSpherical(1.5, 0.0));
  const double far = ProveEnergy(network, {.max_pieces = 1}).bound;
  const EnergyProof near = ProveEnergy(network);
  EXPECT_GT(far, 1.1);
  EXPECT_TRUE(near.IsProved()) << near.bound << " " << albedo;
  EXPECT_GE(near.bound, albedo);
}

}  // namespace
}  // namespace pbnbrdf
