// Energy, conserved by whole fits, small ones.
#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/solve/fit.h"
#include "solve/one_channel.h"
#include "solve/small_problem.h"

namespace pbnbrdf {
namespace {

// Half a sphere of white: brighter than anything physical, albedo 1.2.
NeuralBrdf TooBright() {
  const NetworkShape shape(Encoding::kMultiscale, {2}, Activation::kTanh);
  std::vector<double> weights(shape.num_weights(), 0.0);
  for (int c = 1; c <= 3; ++c) weights[shape.offset(1) + 3 * c - 1] = std::log1p(1.2 / kPi);
  return NeuralBrdf(shape, weights);
}

// At 0.5 radians of incidence, red.
double AlbedoOf(const Brdf& brdf) { return DirectionalAlbedo(brdf, FromSpherical(0.5, 0.0))[0]; }

TEST(EnergyConservation, AdamsEnergyTermPullsTheAlbedoDown) {
  FitProblem problem = SmallProblem();
  problem.terms.energy_theta = 16;
  problem.terms.energy_phi = 8;
  FitOptions options;
  options.solver = "adam";
  options.adam.batch = 50;
  options.adam.learning_rate = 2e-3;
  options.schedule.max_iterations = 100;
  options.certify_energy = false;
  const NeuralBrdf bright = TooBright();
  EXPECT_NEAR(AlbedoOf(FitBrdf(bright, problem, options).network), 1.2, 0.05);
  problem.terms.SetWeight("energy", 1.0);
  options.threads = 1;
  const Fit one = FitBrdf(bright, problem, options);
  EXPECT_LT(AlbedoOf(one.network), 1.03);
  EXPECT_GT(AlbedoOf(one.network), 0.75);
  options.threads = 2;
  EXPECT_EQ(one.network.weights(), FitBrdf(bright, problem, options).network.weights());
}

std::unique_ptr<Brdf> MetalOfAlbedo(double albedo) {
  return ScaleToAlbedo(std::make_unique<GgxBrdf>(Rgb{0.9, 0.8, 0.7}, 0.3), albedo);
}

TEST(EnergyConservation, WithoutTheTermBrightMaterialsStayBright) {
  const auto too_bright = MetalOfAlbedo(1.2);
  const Fit fit = FitBrdf(*too_bright, SmallProblem(), {});
  EXPECT_EQ(fit.summary.energy.rounds, 0);
  EXPECT_NEAR(AlbedoOf(fit.network), AlbedoOf(*too_bright), 0.02);
}

class EnergyConservationTest : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(EnergyConservationTest, IsConservedWhereTheMaterialDoesNot) {
  const auto too_bright = MetalOfAlbedo(1.2);
  FitProblem problem = SmallProblem();
  problem.terms.energy_theta = 32;
  problem.terms.energy_phi = 16;
  problem.terms.SetWeight("energy", GetParam().second);
  FitOptions options;
  options.solver = GetParam().first;
  options.schedule.max_iterations = options.solver == "ceres_lbfgs" ? 1000 : 200;
  const Fit fit = FitBrdf(*too_bright, problem, options);
  const EnergySummary& energy = fit.summary.energy;
  // With three times the nodes of the usual check, which is off by 2e-4 for one of these networks.
  EXPECT_LE(MeasureEnergy(fit.network, {.n_theta = 6}).max_directional_albedo, 1.0 + 1e-6);
  EXPECT_NEAR(AlbedoOf(fit.network), std::min(AlbedoOf(*too_bright), 1.0), 0.05);
  EXPECT_GT(energy.first_max_albedo, 1.1);
  EXPECT_GT(energy.rounds, 0);
  EXPECT_LT(energy.correction, 0.01);
  EXPECT_GT(energy.work.jacobians, 0);
}

INSTANTIATE_TEST_SUITE_P(SolversAndWeights, EnergyConservationTest,
                         testing::Values(std::pair{"lm", 1e-9}, std::pair{"lm", 1e300},
                                         std::pair{"ceres_lm", 1.0},
                                         std::pair{"ceres_lbfgs", 1.0}));

TEST(EnergyConservation, WithoutRoundsTheCorrectionAloneConservesEnergy) {
  FitProblem problem = SmallProblem();
  problem.terms.SetWeight("energy", 1.0);
  FitOptions options;
  options.solver = "adam";
  options.adam.learning_rate = 1e-6;
  options.schedule.max_iterations = 3;
  options.adam.batch = 50;
  options.initial_weights = TooBright().weights();
  problem.network.hidden = {2};
  problem.network.encoding = Encoding::kMultiscale;
  const Fit fit = FitBrdf(TooBright(), problem, options);
  EXPECT_TRUE(MeasureEnergy(fit.network).Conserved());
  EXPECT_GT(fit.summary.energy.correction, 0.0);
  EXPECT_GT(AlbedoOf(fit.network), 0.9);
  EXPECT_EQ(MeasureReciprocity(fit.network).hrl, 0.0);
}

TEST(EnergyConservation, SkippingStrataChangesNothing) {
  FitProblem problem = SmallProblem();
  problem.terms.SetWeight("energy", 1.0);
  problem.terms.energy_skip = false;
  const Fit all = FitBrdf(*MetalOfAlbedo(1.001), problem, {});
  problem.terms.energy_skip = true;
  const Fit skipped = FitBrdf(*MetalOfAlbedo(1.001), problem, {});
  EXPECT_EQ(all.network.weights(), skipped.network.weights());
  EXPECT_GT(all.summary.energy.rounds, 0);
  EXPECT_EQ(all.summary.energy.work.albedos_skipped, 0);
  EXPECT_EQ(all.summary.energy.work.albedos,
            skipped.summary.energy.work.albedos + skipped.summary.energy.work.albedos_skipped);
}

TEST(EnergyConservation, DarkMaterialsCarryNoEnergyTerm) {
  FitProblem problem = SmallProblem();
  const auto iron = MakeBuiltin("rough-iron");
  const Fit without = FitBrdf(*iron, problem, {});
  problem.terms.SetWeight("energy", 1.0);
  const Fit with = FitBrdf(*iron, problem, {});
  EXPECT_EQ(with.network.weights(), without.network.weights());
  EXPECT_EQ(with.summary.energy.work.albedos, 0);
  EXPECT_LT(with.summary.energy.first_max_albedo, 0.9);
}

// By the rounds of the energy term, and, from a network that shines by itself, by the correction.
TEST(EnergyConservation, EnergyOfOneChannelIsConservedToo) {
  const ScatteredBrdf bright = MeasuredInOneChannel(LambertBrdf({1.3, 1.3, 1.3}), 1000);
  FitProblem problem = SmallProblem();
  problem.network.channels = 1;
  problem.network.hidden = {4};
  problem.terms.SetWeight("energy", 1.0);
  problem.terms.energy_theta = 32;
  problem.terms.energy_phi = 16;
  FitOptions rounds, correction;
  rounds.schedule.max_iterations = 30;
  correction.solver = "adam";
  correction.adam.learning_rate = 1e-6;
  correction.schedule.max_iterations = 3;
  // Nearly constant; of an exact constant rounding decides whether a fit can go on.
  correction.initial_weights.assign(problem.Shape().num_weights(), 1e-8);
  correction.initial_weights.back() = std::log1p(1.3 / kPi);
  for (const FitOptions& options : {rounds, correction}) {
    const Fit fit = FitBrdf(bright, problem, options);
    EXPECT_GT(fit.summary.energy.first_max_albedo, 1.25);
    EXPECT_LE(MeasureEnergy(fit.network).max_directional_albedo, 1.0 + 1e-6);
    EXPECT_GT(AlbedoOf(fit.network), 0.9);
    EXPECT_GT(options.solver == "adam" ? fit.summary.energy.correction
                                       : double(fit.summary.energy.rounds),
              0.05);
  }
}

}  // namespace
}  // namespace pbnbrdf
