#include "pbnbrdf/solve/half_weights.h"

#include "network/rounded_network.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/solve/fit.h"
#include "solve/small_problem.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// With the energy term.
NeuralBrdf QuickFit(const Brdf& material) {
  FitProblem problem;
  problem.network.hidden = {8, 8};
  problem.sampling.samples = 5000;
  FitOptions options;
  options.schedule.max_iterations = 150;
  return FitBrdf(material, problem, options).network;
}

TEST(HalfWeights, ChangeLittleForBeingRoundedTogether) {
  const NeuralBrdf network = QuickFit(*MakeBuiltin("satin-gold"));
  const HalfWeights half = ToHalfWeights(network);
  for (const double weight : half.network.weights()) EXPECT_EQ(weight, NearestHalf(weight));
  const double change = MeanAbsDifference(network, half.network);
  EXPECT_LT(change, 0.2 * MeanAbsDifference(network, RoundedOneByOne(network)));
  EXPECT_LT(change, 1e-3);
  EXPECT_LT(half.mean_change, 1e-3);
  EXPECT_LT(half.mean_change, half.most_change);
  EXPECT_THAT(half.network.metadata().at("half_precision"), HasSubstr("(1 + f) in the mean"));
  // What is rounded already stays.
  EXPECT_EQ(ToHalfWeights(half.network).network.weights(), half.network.weights());
}

// Reflects next to everything at all angles.
class WhiteBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) values[n].fill(0.99999 / kPi);
  }
  bool IsReciprocal() const override { return true; }
  std::string Description() const override { return "white"; }
};

TEST(HalfWeights, ConserveEnergyWhereTheNetworkDid) {
  const NeuralBrdf network = QuickFit(WhiteBrdf());
  const auto albedo = [](const NeuralBrdf& brdf) {
    return Largest(LargestAlbedos(AlbedoProfile(brdf, {})));
  };
  ASSERT_GT(albedo(network), 0.999);
  ASSERT_LE(albedo(network), 1.0);
  const HalfWeights half = ToHalfWeights(network);
  EXPECT_LE(half.max_albedo, 1.0);
  EXPECT_EQ(half.max_albedo, albedo(half.network));
  EXPECT_LT(half.mean_change, 1e-3);
}

TEST(HalfWeights, WhatCannotBeRoundedIsRefused) {
  const NetworkShape wide(Encoding::kMerl, {100, 100}, Activation::kTanh);
  const NeuralBrdf network(wide, std::vector<double>(wide.num_weights(), 0.01));
  EXPECT_THAT(ErrorOf([&] { ToHalfWeights(network); }), HasSubstr("at most 5000 can be rounded"));
  const NetworkShape small(Encoding::kMerl, {2}, Activation::kTanh);
  std::vector<double> weights(small.num_weights(), 0.1);
  weights[0] = 1e6;
  EXPECT_THAT(ErrorOf([&] { ToHalfWeights(NeuralBrdf(small, weights)); }),
              HasSubstr("weight 1e+06 is beyond half precision"));
}

}  // namespace
}  // namespace pbnbrdf
