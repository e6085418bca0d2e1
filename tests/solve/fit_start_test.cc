// What fits begin with: random weights, several of them, given ones; and what leads nowhere.
#include "network/random_network.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/solve/fit.h"
#include "solve/small_problem.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

TEST(FitStart, TheBestStartGoesOn) {
  const FitProblem problem = SmallProblem();
  double least = std::numeric_limits<double>::infinity();
  FitOptions options;
  options.schedule.starts = 4;
  options.schedule.max_iterations = 12;  // of each start, and none is left after them
  options.on_iteration = [&](const FitProgress& progress) {
    least = std::min(least, progress.cost);
    return true;
  };
  const Fit fit = FitBrdf(*MakeBuiltin("satin-gold"), problem, options);
  EXPECT_LE(fit.summary.final_cost, least);
  EXPECT_GT(fit.summary.iterations, 4 * 11);
}

TEST(FitStart, GoesOnFromGivenWeights) {
  const auto gold = MakeBuiltin("satin-gold");
  FitOptions options;
  options.schedule.max_iterations = 20;
  const Fit first = FitBrdf(*gold, SmallProblem(), options);
  options.initial_weights = first.network.weights();
  options.schedule.max_iterations = 0;
  EXPECT_EQ(FitBrdf(*gold, SmallProblem(), options).network.weights(), first.network.weights());
  options.schedule.max_iterations = 20;
  const Fit second = FitBrdf(*gold, SmallProblem(), options);
  EXPECT_LT(second.summary.final_cost, first.summary.final_cost);
}

// Weights of a network of a hidden layer whose units are all dead.
std::vector<double> DeadWeights(const NetworkShape& shape) {
  std::vector<double> weights = RandomWeights(shape, 0.5, /*seed=*/3);
  for (int o = 1; o <= shape.out(0); ++o) weights[o * (shape.in(0) + 1) - 1] = -1000.0;
  return weights;
}

TEST(FitStart, RefusesGivenWeightsThatLeadNowhere) {
  FitProblem problem = SmallProblem();
  const auto error = [&](std::vector<double> weights) {
    FitOptions options;
    options.initial_weights = std::move(weights);
    return ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, options); });
  };
  for (Activation activation : {Activation::kTanh, Activation::kRelu}) {
    problem.network.activation = activation;
    const NetworkShape shape = problem.Shape();
    EXPECT_THAT(error(DeadWeights(shape)), HasSubstr("a constant network that stays one"));
    EXPECT_THAT(error(std::vector<double>(shape.num_weights(), 0.0)),
                HasSubstr("a constant network that stays one"));
    EXPECT_THAT(error(std::vector<double>(shape.num_weights(), 1e30)),
                HasSubstr("the cost or its gradient isn't finite"));
    std::vector<double> weights = RandomWeights(shape, 0.5, /*seed=*/3);
    weights[1] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(error(weights), HasSubstr("initial_weights: one isn't finite"));
  }
}

TEST(FitStart, SaysWhyWhereTheFirstStageCantStart) {
  // The cost and its gradient are finite, J'J isn't in single precision.
  FitProblem problem = SmallProblem();
  problem.terms.loss = Loss::kL2;
  problem.terms.SetWeight("log", 2e39);
  FitOptions options;
  for (const std::string solver : {"lm", "ceres_lm"}) {
    options.solver = solver;
    const std::string error =
        ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, options); });
    EXPECT_THAT(error, HasSubstr("no start: ")) << solver;
    EXPECT_THAT(error, testing::Not(HasSubstr("random"))) << "not of the gradient";
  }
}

TEST(FitStart, AConstantNetworkIsAStartForAConstantMaterial) {
  const FitProblem problem = SmallProblem();
  FitOptions options;
  options.initial_weights = DeadWeights(problem.Shape());
  options.schedule.max_iterations = 20;
  const auto white = MakeBuiltin("spectralon");
  EXPECT_LT(MeanAbsDifference(*white, FitBrdf(*white, problem, options).network), 1e-3);
}

TEST(FitStart, DrawsRandomWeightsAnewWhereAllUnitsAreDead) {
  FitProblem problem = SmallProblem();
  problem.network.hidden = {1, 1};
  problem.network.activation = Activation::kRelu;
  FitOptions options;
  options.schedule.max_iterations = 5;
  const auto gold = MakeBuiltin("satin-gold");
  int restarted = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    problem.sampling.seed = seed;
    const Fit fit = FitBrdf(*gold, problem, options);
    if (fit.summary.restarts == 0) continue;
    ++restarted;
    EXPECT_EQ(FitBrdf(*gold, problem, options).network.weights(), fit.network.weights());
  }
  EXPECT_GT(restarted, 0);
  EXPECT_LT(restarted, 10);
}

TEST(FitStart, APerfectStartIsConvergedAtOnce) {
  // A black material, and a network of zeros but for its units' weights: the cost is 0.
  const FitProblem problem = SmallProblem();
  const NetworkShape shape = problem.Shape();
  std::vector<double> weights = RandomWeights(shape, 0.5, /*seed=*/3);
  std::fill(weights.begin() + shape.offset(1), weights.end(), 0.0);
  const NeuralBrdf black(shape, weights);
  FitOptions options;
  options.initial_weights = weights;
  for (const std::string solver : {"lm", "ceres_lm", "ceres_lbfgs", "adam"}) {
    options.solver = solver;
    options.schedule.max_iterations = 12;
    const Fit fit = FitBrdf(black, problem, options);
    EXPECT_EQ(fit.summary.final_cost, 0.0);
    EXPECT_EQ(fit.network.weights(), weights);
    EXPECT_THAT(fit.summary.message, testing::Not(HasSubstr("nan")));
  }
}

}  // namespace
}  // namespace pbnbrdf
