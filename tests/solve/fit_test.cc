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
  problem.network.encoding = shape.encoding();
  FitOptions options;
  options.precision = Precision::kDouble;
  options.schedule.max_iterations = 200;
  const Fit fit = FitBrdf(truth, problem, options);
  EXPECT_LT(MeanAbsDifference(truth, fit.network), 2e-5);
}

TEST(FitBrdf, FitsAnAnisotropicMaterialAroundTheNormal) {
  const std::unique_ptr<Brdf> brass = MakeBuiltin("rolled-brass");
  FitProblem problem;
  problem.network.hidden = {12, 12};
  problem.sampling.samples = 4000;
  FitOptions options;
  options.schedule.max_iterations = 60;
  const auto error = [&](Encoding encoding) {
    problem.network.encoding = encoding;
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
  problem.network.encoding = Encoding::kAnisotropic;
  EXPECT_THAT(ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, {}); }),
              HasSubstr("encoding: anisotropic is for anisotropic materials"));
}

TEST(FitBrdf, IsTheSameToTheBitForAnyNumberOfThreads) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 3000;
  FitOptions options;
  options.schedule.max_iterations = 10;
  std::vector<double> weights[2];
  for (int threads : {1, 2}) {
    options.threads = threads;
    weights[threads - 1] = FitBrdf(*MakeBuiltin("satin-gold"), problem, options).network.weights();
  }
  EXPECT_EQ(weights[0], weights[1]);
}

TEST(FitBrdf, CondensedTakesTheStepsOfTheAutodiffProblem) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 300;
  problem.terms.SetWeight("chromaticity", 0.1);
  FitOptions options;
  options.precision = Precision::kDouble;
  options.solver = "ceres_lm";
  options.schedule.max_iterations = 6;
  std::vector<double> costs[2];
  costs[0] = CostTrace(problem, options);
  options.solver = "autodiff";
  costs[1] = CostTrace(problem, options);
  ASSERT_EQ(costs[0].size(), costs[1].size());
  for (std::size_t i = 0; i < costs[0].size(); ++i) {
    EXPECT_NEAR(costs[0][i], costs[1][i], 1e-6 * costs[1][i]) << "iteration " << i;
  }
}

TEST(FitBrdf, LmTakesTheStepsOfCeres) {
  FitProblem problem = SmallProblem();
  FitOptions options;
  options.acceleration = false;
  options.precision = Precision::kDouble;
  options.schedule.max_iterations = 12;
  options.schedule.function_tolerance = 0.0;
  std::vector<double> costs[2];
  costs[0] = CostTrace(problem, options);
  options.solver = "ceres_lm";
  costs[1] = CostTrace(problem, options);
  ASSERT_EQ(costs[0].size(), 13u);
  ASSERT_EQ(costs[1].size(), 13u);
  // Ceres reports the cost of the last step, lm the least so far.
  double least = costs[1][0];
  for (std::size_t i = 0; i <= 12; ++i) {
    least = std::min(least, costs[1][i]);
    EXPECT_NEAR(costs[0][i], least, 1e-4 * least) << "iteration " << i;
  }
}

TEST(FitBrdf, LbfgsComesNearToo) {
  FitProblem problem = SmallProblem();
  problem.terms.loss = Loss::kL2;
  FitOptions options;
  options.precision = Precision::kDouble;
  options.solver = "ceres_lbfgs";
  options.schedule.max_iterations = 1000;
  options.schedule.function_tolerance = 1e-9;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit fit = FitBrdf(*gold, problem, options);
  options.schedule.max_iterations = 0;
  const Fit start = FitBrdf(*gold, problem, options);
  EXPECT_EQ(start.summary.iterations, 0);
  EXPECT_LT(MeanAbsDifference(*gold, fit.network), 0.05 * MeanAbsDifference(*gold, start.network));
}

TEST(FitBrdf, AdamComesNearAndIsTheSameForAnyNumberOfThreads) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 5000;
  FitOptions options;
  options.solver = "adam";
  options.adam.learning_rate = 5e-3;
  options.schedule.max_iterations = 30;
  const auto gold = MakeBuiltin("satin-gold");
  options.threads = 1;
  const Fit one = FitBrdf(*gold, problem, options);
  options.threads = 2;
  const Fit two = FitBrdf(*gold, problem, options);
  EXPECT_EQ(one.network.weights(), two.network.weights());
  options.schedule.max_iterations = 0;
  const Fit start = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, two.network), 0.3 * MeanAbsDifference(*gold, start.network));
}

TEST(FitBrdf, LbfgsMinimisesThePapersSumToo) {
  FitProblem problem = SmallProblem();
  problem.terms.loss = Loss::kAbsolute;
  problem.terms.SetWeight("chromaticity", 0.1);
  FitOptions options;
  options.solver = "ceres_lbfgs";
  options.schedule.max_iterations = 500;
  const std::vector<double> costs = CostTrace(problem, options);
  EXPECT_LT(costs.back(), 0.1 * costs.front());
  EXPECT_TRUE(std::is_sorted(costs.rbegin(), costs.rend()));
}

TEST(FitBrdf, SecondOrderSolversRefuseWhatIsNoSumOfSquares) {
  FitProblem problem = SmallProblem();
  problem.terms.loss = Loss::kAbsolute;
  const auto error = [&](const std::string& solver) {
    FitOptions options;
    options.solver = solver;
    return ErrorOf([&] { ValidateFit(problem, options); });
  };
  for (const std::string solver : {"lm", "ceres_lm", "autodiff"}) {
    EXPECT_THAT(error(solver), HasSubstr("absolute isn't a sum of squares"));
  }
  EXPECT_EQ(error("ceres_lbfgs"), "");
  EXPECT_EQ(error("adam"), "");
}

TEST(FitBrdf, OneChannelIsFittedByOneOutputWithEverySolver) {
  const auto material = MakeBuiltin("rough-iron");
  const ScatteredBrdf measured = MeasuredInOneChannel(*material, 3000);
  FitProblem problem = SmallProblem();
  problem.network.channels = measured.NumChannels();
  problem.sampling.samples = 3000;
  for (const std::string solver : {"lm", "ceres_lm", "ceres_lbfgs", "adam"}) {
    FitOptions options;
    options.solver = solver;
    options.schedule.max_iterations = solver == "adam" ? 60 : 100;
    options.adam.learning_rate = 5e-3;
    options.adam.batch = 50;
    const Fit fit = FitBrdf(measured, problem, options);
    EXPECT_EQ(fit.network.NumChannels(), 1);
    EXPECT_EQ(fit.network.weights().size(), 7u * 6 + 7);
    const HeldOutErrors errors = MeasureErrors(HeldOutSamples(measured, 1000, 1), fit.network);
    EXPECT_LT(errors.mean_abs_log_error, 0.02) << solver;
    EXPECT_EQ(errors.samples, measured.Measurements().size() / 8);
  }
}

TEST(FitBrdf, ChannelsThatDontSuitAreNamed) {
  FitProblem problem = SmallProblem();
  problem.network.channels = 1;
  EXPECT_THAT(ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), problem, {}); }),
              HasSubstr("channels: the material has 3, the network's 1 would be a guess"));
  problem.terms.SetWeight("chromaticity", 0.1);
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
  problem.sampling.samples = 4000;
  problem.network.hidden = {12, 12};
  const ScatteredBrdf measured(data);
  const Fit fit = FitBrdf(measured, problem, {});
  EXPECT_LT(MeasureErrors(HeldOutSamples(measured, 1000, 1), fit.network).mean_abs_log_error, 0.01);
  EXPECT_LT(DirectionalAlbedo(fit.network, FromSpherical(0.5, 0.0))[0], 2.0);
}

TEST(FitBrdf, GrowingSamplesEndNearTheErrorOfAllAtOnce) {
  FitProblem problem;
  problem.network.hidden = {8, 8};
  problem.sampling.samples = 4000;
  problem.terms.SetWeight("energy", 0.0);
  FitOptions options;
  options.schedule.max_iterations = 100;
  const auto gold = MakeBuiltin("satin-gold");
  options.schedule.first_samples = problem.sampling.samples;
  const Fit all = FitBrdf(*gold, problem, options);
  options.schedule.first_samples = 300;
  const Fit grown = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, grown.network), 3.0 * MeanAbsDifference(*gold, all.network));
  EXPECT_LE(grown.summary.iterations, 100);
}

// What all solvers have in common: when they stop, and what they report.
class EverySolver : public testing::TestWithParam<std::string> {
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
    options.schedule.function_tolerance = 0.0;
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
  const Run run = Fit([](FitOptions* options) { options->schedule.max_iterations = 4; });
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
    options->schedule.max_iterations = 1000;
    options->schedule.function_tolerance = 0.3;
  });
  EXPECT_EQ(run.summary.termination, Termination::kConverged);
  EXPECT_LT(run.summary.iterations, 1000);
  EXPECT_NE(run.summary.message, "");
}

TEST_P(EverySolver, StopsOnTime) {
  const Run run = Fit([](FitOptions* options) {
    options->schedule.max_iterations = 1000000;
    options->schedule.max_seconds = 1e-3;
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
                         testing::Values("lm", "ceres_lm", "ceres_lbfgs", "adam"),
                         [](const auto& test) { return std::string(test.param); });

// The part of the time that is kept for the energy term goes to the fit if the term isn't needed.
TEST(FitBrdf, AFitThatConservesEnergyUsesItsTime) {
  FitOptions options;
  options.schedule.max_iterations = 1000000;
  options.schedule.max_seconds = 3.0;
  options.schedule.function_tolerance = options.schedule.error_tolerance =
      0.0;  // nothing else ends it
  const FitSummary summary = FitBrdf(*MakeBuiltin("rough-iron"), FitProblem{}, options).summary;
  ASSERT_EQ(summary.termination, Termination::kMaxSeconds);
  EXPECT_GT(summary.seconds, 0.75 * options.schedule.max_seconds);
  EXPECT_EQ(summary.energy.rounds, 0);
}

TEST(FitBrdf, AdamsToleranceIsOfTheMeanOverFiveEpochs) {
  FitOptions options;
  options.solver = "adam";
  options.schedule.max_iterations = 100;
  options.schedule.function_tolerance = 10.0;  // the first two means that there are will do
  const Fit fit = FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options);
  EXPECT_EQ(fit.summary.iterations, 10);
  EXPECT_THAT(fit.summary.message, HasSubstr("mean cost of the last 5 epochs"));
}

TEST(FitBrdf, SaysWhenSinglePrecisionLimitsIt) {
  // A network of this size comes as near to gold as it can, which is not near; to itself it could
  // come without end.
  FitProblem problem = SmallProblem();
  FitOptions options;
  options.schedule.max_iterations = 100;
  const Fit gold = FitBrdf(*MakeBuiltin("satin-gold"), problem, options);
  EXPECT_FALSE(gold.summary.precision_limited);
  options.initial_weights = gold.network.weights();
  EXPECT_TRUE(FitBrdf(gold.network, problem, options).summary.precision_limited);
  options.precision = Precision::kDouble;
  EXPECT_FALSE(FitBrdf(gold.network, problem, options).summary.precision_limited);
}

TEST(FitBrdf, AccelerationGetsFurther) {
  FitProblem problem = SmallProblem();
  problem.network.hidden = {12, 12};
  problem.sampling.samples = 4000;
  FitOptions options;
  options.precision = Precision::kDouble;
  options.schedule.max_iterations = 100;
  const double bent = CostTrace(problem, options).back();
  options.acceleration = false;
  const double straight = CostTrace(problem, options).back();
  EXPECT_LT(bent, 0.8 * straight);
}

TEST(FitBrdf, CurvatureOfAPartOfTheSamplesServes) {
  FitProblem problem = SmallProblem();
  FitOptions options;
  problem.sampling.samples = options.schedule.first_samples = 4000;
  options.schedule.max_iterations = 60;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit all = FitBrdf(*gold, problem, options);
  options.schedule.curvature_samples = 1000;
  const Fit part = FitBrdf(*gold, problem, options);
  EXPECT_LT(MeanAbsDifference(*gold, part.network), 3.0 * MeanAbsDifference(*gold, all.network));
}

TEST(FitBrdf, AdamThatDivergesReturnsItsBestEpoch) {
  FitProblem problem = SmallProblem();
  problem.network.activation = Activation::kRelu;
  FitOptions options;
  options.solver = "adam";
  options.adam.batch = 50;
  options.adam.learning_rate = 1e30;
  options.schedule.max_iterations = 10;
  const auto gold = MakeBuiltin("satin-gold");
  const Fit fit = FitBrdf(*gold, problem, options);
  EXPECT_EQ(fit.summary.termination, Termination::kDiverged);
  EXPECT_THAT(fit.summary.message, HasSubstr("try a smaller learning rate"));
  EXPECT_TRUE(std::isfinite(fit.summary.final_cost));
  options.schedule.max_iterations = 0;
  EXPECT_LE(fit.summary.final_cost, FitBrdf(*gold, problem, options).summary.final_cost);
}

TEST(FitBrdf, CountsWhatTheSolversMeet) {
  FitProblem problem = SmallProblem();
  problem.network.activation = Activation::kRelu;
  FitOptions options;
  options.schedule.max_iterations = 60;
  for (const std::string solver : {"lm", "ceres_lm"}) {
    options.solver = solver;
    const FitSummary summary = FitBrdf(*MakeBuiltin("polished-chromium"), problem, options).summary;
    EXPECT_GT(summary.rejected_steps, 0);
    EXPECT_LT(summary.rejected_steps + summary.failed_factorizations, summary.iterations);
  }
}

TEST(FitBrdf, SaysWhatProblemItSolved) {
  FitOptions options;
  options.schedule.max_iterations = 1;
  const Fit fit = FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options);
  EXPECT_EQ(fit.problem.network.encoding, Encoding::kMerl);
  EXPECT_EQ(fit.problem.network.channels, 3);
  EXPECT_EQ(fit.problem.sampling.samples, 500u);
}

TEST(FitBrdf, BadOptionsAreNamed) {
  const auto error = [](auto change) {
    FitOptions options;
    change(&options);
    return ErrorOf([&] { FitBrdf(*MakeBuiltin("satin-gold"), SmallProblem(), options); });
  };
  EXPECT_THAT(error([](FitOptions* o) { o->schedule.max_iterations = -1; }),
              HasSubstr("max_iterations = -1"));
  EXPECT_THAT(error([](FitOptions* o) { o->schedule.max_seconds = 0; }),
              HasSubstr("max_seconds = 0"));
  EXPECT_THAT(
      error([](FitOptions* o) { o->solver = "newton"; }),
      HasSubstr("solver=newton is not one of lm | ceres_lm | ceres_lbfgs | adam | autodiff"));
  EXPECT_THAT(error([](FitOptions* o) { o->threads = -2; }), HasSubstr("threads = -2"));
  EXPECT_THAT(error([](FitOptions* o) { o->schedule.starts = 0; }),
              HasSubstr("starts = 0; must be >= 1"));
  EXPECT_THAT(error([](FitOptions* o) { o->schedule.curvature_samples = 0; }),
              HasSubstr("curvature_samples = 0"));
  EXPECT_THAT(error([](FitOptions* o) {
                o->initial_weights = {1.0, 2.0};
              }),
              HasSubstr("initial_weights: 2 numbers, a 6-6-3 tanh network has 63"));
}

}  // namespace
}  // namespace pbnbrdf
