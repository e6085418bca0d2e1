// Wider networks of the same function, and fits that go through them.
#include "solve/widening.h"

#include <random>

#include "brdf/direction_pairs.h"
#include "network/random_network.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/solve/fit.h"
#include "solve/small_problem.h"

namespace pbnbrdf {
namespace {

NetworkShape ShapeOf(std::vector<int> hidden, Activation activation = Activation::kTanh) {
  return NetworkShape(Encoding::kMultiscale, std::move(hidden), activation);
}

TEST(Widen, LeavesTheFunctionAsItIs) {
  const std::vector<DirectionPair> pairs = RandomPairs(300, /*seed=*/3);
  for (Activation activation : {Activation::kTanh, Activation::kRelu}) {
    const NetworkShape narrow = ShapeOf({3, 5, 2}, activation);
    const NetworkShape wide = ShapeOf({7, 5, 6}, activation);
    const std::vector<double> weights = RandomWeights(narrow, 0.8, /*seed=*/1);
    const NeuralBrdf before(narrow, weights);
    const NeuralBrdf after(wide, Widen(narrow, weights, wide, RandomWeights(wide, 0.8, 2)));
    EXPECT_LT(MeanAbsDifference(before, after), 1e-15);
    EXPECT_GT(MeanAbsDifference(before, NeuralBrdf(wide, RandomWeights(wide, 0.8, 2))), 1e-3);
  }
}

TEST(Widen, NewUnitsCanLearn) {
  // Their outputs go nowhere yet, but differ: a unit whose gradient is 0 for good would be dead.
  const NetworkShape narrow = ShapeOf({3}), wide = ShapeOf({6});
  const std::vector<double> weights =
      Widen(narrow, RandomWeights(narrow, 0.5, 1), wide, RandomWeights(wide, 0.5, 2));
  for (int o = 3; o < 6; ++o) EXPECT_NE(weights[7 * o], 0.0) << o;
  EXPECT_NE(weights[7 * 3], weights[7 * 4]);
}

TEST(NarrowedHidden, HasAsManyWeightsAsItMay) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<int> hidden(1 + random() % 4);
    for (int& size : hidden) size = 1 + static_cast<int>(random() % 90);
    const NetworkShape shape = ShapeOf(hidden);
    const std::size_t wanted = 1 + random() % 9000;
    const std::vector<int> narrow = NarrowedHidden(shape, wanted);
    ASSERT_EQ(narrow.size(), hidden.size());
    for (std::size_t l = 0; l < hidden.size(); ++l) {
      EXPECT_GE(narrow[l], 1);
      EXPECT_LE(narrow[l], hidden[l]);
    }
    const int weights = ShapeOf(narrow).num_weights();
    const bool is_least = narrow == std::vector<int>(hidden.size(), 1);
    EXPECT_TRUE(is_least || static_cast<std::size_t>(weights) <= wanted);
    if (static_cast<std::size_t>(shape.num_weights()) <= wanted) {
      EXPECT_EQ(narrow, hidden);
    }
  }
  EXPECT_EQ(NarrowedHidden(ShapeOf({64, 64, 64}), 1000), (std::vector<int>{19, 19, 19}));
  EXPECT_EQ(NarrowedHidden(ShapeOf({40, 20}), 500), (std::vector<int>{23, 11}));
}

// Of a network of 12-12 units, which begins as one of 5-5.
FitProblem WideProblem() {
  FitProblem problem = SmallProblem();
  problem.network.hidden = {12, 12};
  problem.sampling.samples = 2000;
  return problem;
}

FitOptions NarrowFirst() {
  FitOptions options;
  options.schedule.first_weights = 100;
  options.schedule.max_iterations = 60;
  options.schedule.error_tolerance = 0.1;
  return options;
}

TEST(FitBrdf, EndsNearerThanItsNarrowNetwork) {
  const std::unique_ptr<Brdf> gold = MakeBuiltin("satin-gold");
  FitProblem narrow = WideProblem();
  narrow.network.hidden = {5, 5};
  const Fit first = FitBrdf(*gold, narrow, NarrowFirst());
  const Fit wide = FitBrdf(*gold, WideProblem(), NarrowFirst());
  EXPECT_EQ(wide.network.shape().hidden(), (std::vector<int>{12, 12}));
  EXPECT_LT(MeanAbsDifference(*gold, wide.network), 0.5 * MeanAbsDifference(*gold, first.network));
  EXPECT_GT(wide.summary.iterations, first.summary.iterations);
}

TEST(FitBrdf, OfAWideNetworkDoesNotDependOnThreads) {
  const std::unique_ptr<Brdf> gold = MakeBuiltin("satin-gold");
  FitOptions options = NarrowFirst();
  options.threads = 1;
  const Fit one = FitBrdf(*gold, WideProblem(), options);
  options.threads = 2;
  EXPECT_EQ(one.network.weights(), FitBrdf(*gold, WideProblem(), options).network.weights());
}

TEST(FitBrdf, WithoutTimeToWidenHasAllUnits) {
  const std::unique_ptr<Brdf> gold = MakeBuiltin("satin-gold");
  FitOptions options = NarrowFirst();
  options.schedule.max_seconds = 1e-6;
  const Fit fit = FitBrdf(*gold, WideProblem(), options);
  EXPECT_EQ(fit.summary.termination, Termination::kMaxSeconds);
  EXPECT_EQ(fit.network.shape().hidden(), (std::vector<int>{12, 12}));
}

// With more weights than Levenberg-Marquardt takes, and the energy term.
Fit VeryWideFit(const Brdf& material) {
  FitProblem problem = WideProblem();
  problem.network.hidden = {60, 60};
  problem.terms = {};
  FitOptions options = NarrowFirst();
  options.schedule.max_iterations = 8;
  return FitBrdf(material, problem, options);
}

TEST(FitBrdf, VeryWideNetworksConserveEnergy) {
  const auto bright = ScaleToAlbedo(MakeBuiltin("satin-gold"), 1.1);
  const Fit fit = VeryWideFit(*bright);
  EXPECT_EQ(fit.network.weights().size(), 4263u);
  EXPECT_GT(fit.summary.energy.first_max_albedo, 1.01);
  EXPECT_LE(fit.summary.energy.max_albedo, 1.0 + 1e-6);
}

TEST(FitBrdf, VeryWideNetworksAreFitted) {
  const std::unique_ptr<Brdf> laminate = MakeBuiltin("plastic-laminate");
  const Fit fit = VeryWideFit(*laminate);
  EXPECT_EQ(fit.network.weights().size(), 4263u);
  EXPECT_LE(fit.summary.energy.max_albedo, 1.0 + 1e-6);
  EXPECT_LT(MeanAbsDifference(*laminate, fit.network), 0.02);
}

}  // namespace
}  // namespace pbnbrdf
