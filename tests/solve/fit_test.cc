// Whole fits, small ones.
#include "pbnbrdf/solve/fit.h"

#include <algorithm>

#include "brdf/direction_pairs.h"
#include "network/random_network.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/scattered.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "solve/one_channel.h"
#include "solve/small_problem.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// The cost after each iteration of a fit.
std::vector<double> CostTrace(const FitProblem& problem, FitOptions options) {
  std::vector<double> costs;
  options.on_iteration = [&](const FitProgress& progress) {
    costs.push_back(progress.cost);
    return true;
  };
  FitBrdf(*MakeBuiltin("satin-gold"), problem, options);
  return costs;
}

TEST(FitBrdf, FindsANetworkThatExists) {
  // The material is a network of the same shape: predictions must come back, weights may permute.
  const NetworkShape shape(Encoding::kMultiscale, {4}, Activation::kTanh);
  std::vector<double> weights = RandomWeights(shape, 0.7, /*seed=*/5);
  for (int c = 1; c <= 3; ++c) weights[shape.offset(1) + 5 * c - 1] = 1.5;  // positive everywhere
  const NeuralBrdf truth(shape, weights);
  FitProblem problem = SmallProblem();
  problem.encoding = shape.encoding();
  problem.precision = Precision::kDouble;
  FitOptions options;
  options.max_iterations = 200;
  const Fit fit = FitBrdf(truth, problem, options);
  EXPECT_LT(MeanAbsDifference(truth, fit.network), 2e-5);
}

TEST(FitBrdf, FitsAnAnisotropicMaterialAroundTheNormal) {
  const std::unique_ptr<Brdf> brass = MakeBuiltin("rolled-brass");
  FitProblem problem;
  problem.hidden = {12, 12};
  problem.samples = 4000;
  FitOptions options;
  options.max_iterations = 60;
  const auto error = [&](Encoding encoding) {
    problem.encoding = encoding;
    const Fit fit = FitBrdf(*brass, problem, options);
    EXPECT_EQ(fit.network.IsIsotropic(), encoding != Encoding::kAnisotropic);
    TemporaryFolder folder;
    fit.network.Write(folder / "brass.safetensors");
    const NeuralBrdf read = NeuralBrdf::Read(folder / "brass.safetensors");
    EXPECT_EQ(MeanAbsDifference(read, fit.network), 0.0);
    return MeanAbsDifference(*brass, read);
  };
  const double anisotropic = error(EncodingFor(*brass)), isotropic = error(Encoding::kMerl);
  EXPECT_LT(anisotropic, 0.008);
  EXPECT_GT(isotropic, 2.5 * anisotropic);
}

TEST(FitBrdf, AnAnisotropicEncodingNeedsAnAnisotropicMaterial) {
  FitProblem problem = SmallProblem();
  problem.encoding = Encoding::kAnisotropic;
  EXPECT_THAT(ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, {}); }),
              HasSubstr("encoding: anisotropic is for anisotropic materials"));
}

TEST(FitBrdf, IsTheSameToTheBitForAnyNumberOfThreads) {
  FitProblem problem = SmallProblem();
  problem.samples = 3000;
  FitOptions options;
  options.max_iterations = 10;
  std::vector<double> weights[2];
  for (int threads : {1, 2}) {
    options.threads = threads;
    weights[threads - 1] = FitBrdf(*MakeBuiltin("satin-gold"), problem, options).network.weights();
  }
  EXPECT_EQ(weights[0], weights[1]);
}

TEST(FitBrdf, CondensedTakesTheStepsOfTheAutodiffProblem) {
  FitProblem problem = SmallProblem();
  problem.precision = Precision::kDouble;
  problem.samples = 300;
  problem.chromaticity_weight = 0.1;
  FitOptions options;
  options.solver = Solver::kLm;
  options.max_iterations = 6;
  std::vector<double> costs[2];
  costs[0] = CostTrace(problem, options);
  options.jacobian = JacobianMethod::kAutodiff;
  costs[1] = CostTrace(problem, options);
  ASSERT_EQ(costs[0].size(), costs[1].size());
  for (std::size_t i = 0; i < costs[0].size(); ++i) {
    EXPECT_NEAR(costs[0][i], costs[1][i], 1e-6 * costs[1][i]) << "iteration " << i;
  }
}

TEST(FitBrdf, TinyLmTakesTheStepsOfCeres) {
  FitProblem problem = SmallProblem();
  problem.precision = Precision::kDouble;
  FitOptions options;
  options.max_iterations = 12;
  options.function_tolerance = 0.0;
  std::vector<double> costs[2];
  costs[0] = CostTrace(problem, options);
  options.solver = Solver::kLm;
  costs[1] = CostTrace(problem, options);
  ASSERT_EQ(costs[0].size(), 13u);
  ASSERT_EQ(costs[1].size(), 13u);
  // Ceres reports the cost of the last step, tiny_lm the least so far.
  double least = costs[1][0];
  for (std::size_t i = 0; i <= 12; ++i) {
    least = std::min(least, costs[1][i]);
    EXPECT_NEAR(costs[0][i], least, 1e-4 * least) << "iteration " << i;
  }
}

TEST(FitBrdf, LbfgsComesNearToo) {
  FitProblem problem = SmallProblem();
  problem.precision = Precision::kDouble;
  problem.loss = Loss::kL2;
  FitOptions options;
  options.solver = Solver::kLbfgs;
  options.max_iterations = 1000;
  options.function_tolerance = 1e-9;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit fit = FitBrdf(*gold, problem, options);
  options.max_iterations = 0;
  const Fit start = FitBrdf(*gold, problem, options);
  EXPECT_EQ(start.summary.iterations, 0);
  EXPECT_LT(MeanAbsDifference(*gold, fit.network), 0.05 * MeanAbsDifference(*gold, start.network));
}

TEST(FitBrdf, AdamComesNearAndIsTheSameForAnyNumberOfThreads) {
  FitProblem problem = SmallProblem();
  problem.samples = 5000;
  FitOptions options;
  options.solver = Solver::kAdam;
  options.adam.learning_rate = 5e-3;
  options.max_iterations = 30;
  const auto gold = MakeBuiltin("satin-gold");
  options.threads = 1;
  const Fit one = FitBrdf(*gold, problem, options);
  options.threads = 2;
  const Fit two = FitBrdf(*gold, problem, options);
  EXPECT_EQ(one.network.weights(), two.network.weights());
  options.max_iterations = 0;
  const Fit start = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, two.network), 0.3 * MeanAbsDifference(*gold, start.network));
}

TEST(FitBrdf, LbfgsMinimisesThePapersSumToo) {
  FitProblem problem = SmallProblem();
  problem.loss = Loss::kAbsolute;
  problem.chromaticity_weight = 0.1;
  FitOptions options;
  options.solver = Solver::kLbfgs;
  options.max_iterations = 500;
  const std::vector<double> costs = CostTrace(problem, options);
  EXPECT_LT(costs.back(), 0.1 * costs.front());
  EXPECT_TRUE(std::is_sorted(costs.rbegin(), costs.rend()));
}

TEST(FitBrdf, SecondOrderSolversRefuseWhatIsNoSumOfSquares) {
  FitProblem problem = SmallProblem();
  problem.loss = Loss::kAbsolute;
  const auto error = [&](Solver solver, JacobianMethod jacobian) {
    FitOptions options;
    options.solver = solver;
    options.jacobian = jacobian;
    return ErrorOf([&] { ValidateFit(problem, options); });
  };
  for (Solver solver : {Solver::kTinyLm, Solver::kLm}) {
    EXPECT_THAT(error(solver, JacobianMethod::kCondensed),
                HasSubstr("absolute isn't a sum of squares"));
  }
  // The automatic Jacobian is always LM's.
  EXPECT_NE(error(Solver::kLbfgs, JacobianMethod::kAutodiff), "");
  EXPECT_EQ(error(Solver::kLbfgs, JacobianMethod::kCondensed), "");
  EXPECT_EQ(error(Solver::kAdam, JacobianMethod::kCondensed), "");
}

TEST(FitBrdf, OneChannelIsFittedByOneOutputWithEverySolver) {
  const auto material = MakeBuiltin("rough-iron");
  const ScatteredBrdf measured = MeasuredInOneChannel(*material, 3000);
  FitProblem problem = SmallProblem();
  problem.channels = measured.NumChannels();
  problem.samples = 3000;
  for (Solver solver : {Solver::kTinyLm, Solver::kLm, Solver::kLbfgs, Solver::kAdam}) {
    FitOptions options;
    options.solver = solver;
    options.max_iterations = solver == Solver::kAdam ? 60 : 100;
    options.adam.learning_rate = 5e-3;
    options.adam.batch = 50;
    const Fit fit = FitBrdf(measured, problem, options);
    EXPECT_EQ(fit.network.NumChannels(), 1);
    EXPECT_EQ(fit.network.weights().size(), 7u * 6 + 7);
    const HeldOutErrors errors = MeasureErrors(HeldOutSamples(measured, 1000, 1), fit.network);
    EXPECT_LT(errors.mean_abs_log_error, 0.02) << NameOf(kSolvers, solver);
    EXPECT_EQ(errors.samples, measured.Measurements().size() / 8);
  }
}

TEST(FitBrdf, ChannelsThatDontSuitAreNamed) {
  FitProblem problem = SmallProblem();
  problem.channels = 1;
  EXPECT_THAT(ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, {}); }),
              HasSubstr("channels: the material has 3, the network's 1 would be a guess"));
  problem.chromaticity_weight = 0.1;
  EXPECT_THAT(ErrorOf([&] { problem.Validate(); }),
              HasSubstr("terms: chromaticity is of no use to a single channel"));
}

// What is measured at a few theta_i only leaves the rest of the hemisphere open.
TEST(FitBrdf, GapsBetweenMeasurementsStayTame) {
  const auto material = MakeBuiltin("rough-iron");
  ScatteredData data;
  for (double theta_i : {0.2, 1.0}) {
    for (const DirectionPair& pair : RandomPairs(500, /*seed=*/9)) {
      const DirectionPair turned = {FromSpherical(theta_i, 0.0), pair.wo};
      Rgb value;
      material->Evaluate({&turned, 1}, {&value, 1});
      data.samples.push_back({turned, value});
    }
  }
  FitProblem problem = SmallProblem();
  problem.samples = 4000;
  problem.hidden = {12, 12};
  const ScatteredBrdf measured(data);
  const Fit fit = FitBrdf(measured, problem, {});
  EXPECT_LT(MeasureErrors(HeldOutSamples(measured, 1000, 1), fit.network).mean_abs_log_error, 0.01);
  EXPECT_LT(DirectionalAlbedo(fit.network, FromSpherical(0.5, 0.0))[0], 2.0);
}

TEST(FitBrdf, GrowingSamplesEndNearTheErrorOfAllAtOnce) {
  FitProblem problem;
  problem.hidden = {8, 8};
  problem.samples = 4000;
  problem.energy_weight = 0.0;
  FitOptions options;
  options.max_iterations = 100;
  const auto gold = MakeBuiltin("satin-gold");
  problem.first_samples = problem.samples;
  const Fit all = FitBrdf(*gold, problem, options);
  problem.first_samples = 300;
  const Fit grown = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, grown.network), 3.0 * MeanAbsDifference(*gold, all.network));
  EXPECT_LE(grown.summary.iterations, 100);
}

// What all solvers have in common: when they stop, and what they report.
class EverySolver : public testing::TestWithParam<Solver> {
 protected:
  struct Run {
    std::vector<FitProgress> trace;
    FitSummary summary;
  };

  // tolerance and seconds: 0 and an hour, so that none but what `change` sets stops it.
  template <typename Change>
  static Run Fit(Change change) {
    FitOptions options;
    options.solver = GetParam();
    options.function_tolerance = 0.0;
    Run run;
    options.on_iteration = [&](const FitProgress& progress) {
      run.trace.push_back(progress);
      return true;
    };
    change(&options);
    run.summary = FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options).summary;
    return run;
  }
};

TEST_P(EverySolver, StopsAfterTheMostIterationsAndTracesThem) {
  const Run run = Fit([](FitOptions* options) { options->max_iterations = 4; });
  EXPECT_EQ(run.summary.termination, Termination::kMaxIterations);
  EXPECT_EQ(run.summary.iterations, 4);
  EXPECT_NE(run.summary.message, "");
  EXPECT_GT(run.summary.seconds, 0.0);
  ASSERT_EQ(run.trace.size(), 5u);
  for (int i = 0; i <= 4; ++i) {
    EXPECT_EQ(run.trace[i].iteration, i);
    EXPECT_TRUE(std::isfinite(run.trace[i].cost));
    EXPECT_GT(run.trace[i].heldout_error, 0.0);
    EXPECT_GE(run.trace[i].seconds, i > 0 ? run.trace[i - 1].seconds : 0.0);
  }
  EXPECT_LT(run.summary.final_cost, run.trace[0].cost);
  EXPECT_LE(run.summary.final_cost, run.trace[4].cost);
}

TEST_P(EverySolver, StopsOnTheTolerance) {
  const Run run = Fit([](FitOptions* options) {
    options->max_iterations = 1000;
    options->function_tolerance = 0.3;
  });
  EXPECT_EQ(run.summary.termination, Termination::kConverged);
  EXPECT_LT(run.summary.iterations, 1000);
  EXPECT_NE(run.summary.message, "");
}

TEST_P(EverySolver, StopsOnTime) {
  const Run run = Fit([](FitOptions* options) {
    options->max_iterations = 1000000;
    options->max_seconds = 1e-3;
  });
  EXPECT_EQ(run.summary.termination, Termination::kMaxSeconds);
}

TEST_P(EverySolver, StopsWhenAsked) {
  std::vector<double> costs;
  const Run run = Fit([&](FitOptions* options) {
    options->on_iteration = [&](const FitProgress& progress) {
      costs.push_back(progress.cost);
      return progress.iteration < 3;
    };
  });
  EXPECT_EQ(run.summary.termination, Termination::kInterrupted);
  EXPECT_EQ(run.summary.iterations, 3);
  EXPECT_LE(run.summary.final_cost, costs.back());
}

INSTANTIATE_TEST_SUITE_P(Solvers, EverySolver,
                         testing::Values(Solver::kTinyLm, Solver::kLm, Solver::kLbfgs,
                                         Solver::kAdam),
                         [](const auto& test) {
                           return std::string(NameOf(kSolvers, test.param));
                         });

TEST(FitBrdf, AdamsToleranceIsOfTheMeanOverFiveEpochs) {
  FitOptions options;
  options.solver = Solver::kAdam;
  options.max_iterations = 100;
  options.function_tolerance = 10.0;  // the first two means that there are will do
  const Fit fit = FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options);
  EXPECT_EQ(fit.summary.iterations, 10);
  EXPECT_THAT(fit.summary.message, HasSubstr("mean cost of the last 5 epochs"));
}

TEST(FitBrdf, SaysWhenSinglePrecisionLimitsIt) {
  // A network of this size comes as near to gold as it can, which is not near; to itself it could
  // come without end.
  FitProblem problem = SmallProblem();
  FitOptions options;
  options.max_iterations = 100;
  const Fit gold = FitBrdf(*MakeBuiltin("satin-gold"), problem, options);
  EXPECT_FALSE(gold.summary.precision_limited);
  options.initial_weights = gold.network.weights();
  EXPECT_TRUE(FitBrdf(gold.network, problem, options).summary.precision_limited);
  problem.precision = Precision::kDouble;
  EXPECT_FALSE(FitBrdf(gold.network, problem, options).summary.precision_limited);
}

TEST(FitBrdf, CurvatureOfAPartOfTheSamplesServes) {
  FitProblem problem = SmallProblem();
  problem.samples = problem.first_samples = 4000;
  FitOptions options;
  options.max_iterations = 60;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit all = FitBrdf(*gold, problem, options);
  options.curvature_samples = 1000;
  const Fit part = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, part.network), 3.0 * MeanAbsDifference(*gold, all.network));
}

TEST(FitBrdf, AdamThatDivergesReturnsItsBestEpoch) {
  FitProblem problem = SmallProblem();
  problem.activation = Activation::kRelu;
  FitOptions options;
  options.solver = Solver::kAdam;
  options.adam.batch = 50;
  options.adam.learning_rate = 1e30;
  options.max_iterations = 10;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit fit = FitBrdf(*gold, problem, options);
  EXPECT_EQ(fit.summary.termination, Termination::kDiverged);
  EXPECT_THAT(fit.summary.message, HasSubstr("try a smaller learning rate"));
  EXPECT_TRUE(std::isfinite(fit.summary.final_cost));
  options.max_iterations = 0;
  EXPECT_LE(fit.summary.final_cost, FitBrdf(*gold, problem, options).summary.final_cost);
}

TEST(FitBrdf, CountsWhatTheSolversMeet) {
  FitProblem problem = SmallProblem();
  problem.activation = Activation::kRelu;
  problem.loss = Loss::kHuber;
  FitOptions options;
  options.max_iterations = 60;
  for (Solver solver : {Solver::kTinyLm, Solver::kLm}) {
    options.solver = solver;
    const FitSummary summary = FitBrdf(*MakeBuiltin("polished-chromium"), problem, options).summary;
    EXPECT_GT(summary.rejected_steps, 0);
    EXPECT_LT(summary.rejected_steps + summary.failed_factorizations, summary.iterations);
  }
}

TEST(FitBrdf, BadOptionsAreNamed) {
  const auto error = [](auto change) {
    FitOptions options;
    change(&options);
    return ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options); });
  };
  EXPECT_THAT(error([](FitOptions* o) { o->max_iterations = -1; }),
              HasSubstr("max_iterations = -1"));
  EXPECT_THAT(error([](FitOptions* o) { o->max_seconds = 0; }), HasSubstr("max_seconds = 0"));
  EXPECT_THAT(error([](FitOptions* o) { o->threads = -2; }), HasSubstr("threads = -2"));
  EXPECT_THAT(error([](FitOptions* o) { o->starts = 0; }), HasSubstr("starts = 0"));
  EXPECT_THAT(error([](FitOptions* o) { o->curvature_samples = 0; }),
              HasSubstr("curvature_samples = 0"));
  EXPECT_THAT(error([](FitOptions* o) {
                o->initial_weights = {1.0, 2.0};
              }),
              HasSubstr("initial_weights: 2 numbers, a 6-6-3 tanh network has 63"));
}

}  // namespace
}  // namespace pbnbrdf
