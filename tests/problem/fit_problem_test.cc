#include "pbnbrdf/problem/fit_problem.h"

#include <ceres/loss_function.h>

#include "pbnbrdf/models/builtin.h"
#include "problem/initial_weights.h"
#include "problem/robust_loss.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

TEST(FitProblem, ErrorsNameFieldValueAndBound) {
  const auto error = [](auto change) {
    FitProblem problem;
    change(&problem);
    return ErrorOf([&] { problem.Validate(); });
  };
  EXPECT_EQ(error([](FitProblem*) {}), "");
  EXPECT_THAT(error([](FitProblem* p) { p->terms.SetWeight("log", -1); }),
              HasSubstr("terms: the weight of log = -1; must be finite and > 0"));
  EXPECT_THAT(error([](FitProblem* p) { p->terms.SetWeight("energy", std::nan("")); }),
              HasSubstr("terms: the weight of energy = nan"));
  EXPECT_THAT(error([](FitProblem* p) { p->terms.SetWeight("log", 0); }), HasSubstr("terms: "));
  EXPECT_THAT(error([](FitProblem* p) { p->terms.loss_scale = 0; }),
              HasSubstr("must be finite and > 0"));
  EXPECT_THAT(error([](FitProblem* p) { p->sampling.samples = 0; }),
              HasSubstr("samples = 0; must be 1 to"));
  EXPECT_THAT(error([](FitProblem* p) { p->network.hidden = {}; }), HasSubstr("hidden: 0 layers"));
  EXPECT_THAT(error([](FitProblem* p) {
                p->network.hidden = {21, 0};
              }),
              HasSubstr("hidden = 0; must be 1 to 256"));
  EXPECT_THAT(error([](FitProblem* p) { p->terms.energy_theta = -1; }), HasSubstr("energy_theta"));
}

TEST(FitProblem, ATermIsThereOnceAndKnown) {
  FitProblem problem;
  problem.terms.weights = {{"log", 1.0}, {"log", 2.0}};
  EXPECT_THAT(ErrorOf([&] { problem.Validate(); }), HasSubstr("terms: log is there twice"));
  problem.terms.weights = {{"logs", 1.0}};
  EXPECT_THAT(ErrorOf([&] { problem.Validate(); }),
              HasSubstr("terms=logs is not one of log | chromaticity | energy"));
}

TEST(FitProblem, IsSettledForAMaterial) {
  const FitProblem problem;
  const FitProblem brass = problem.For(*MakeBuiltin("rolled-brass"));
  EXPECT_EQ(brass.network.encoding, Encoding::kAnisotropic);
  EXPECT_EQ(brass.network.channels, 3);
  EXPECT_EQ(problem.For(*MakeBuiltin("satin-gold")).network.encoding, Encoding::kMerl);
  EXPECT_EQ(problem.Shape().Description(), "6-21-21-3 tanh");
}

TEST(Loss, EachIsConcaveWithRhoOfZeroZero) {
  // What the condensed block needs for its square root to be real.
  for (const auto& [name, loss] : kLosses) {
    TermOptions terms;
    terms.loss = loss;
    terms.loss_scale = 0.1;
    const auto rho = MakeLoss(terms);
    if (loss == Loss::kL2 || loss == Loss::kAbsolute) {
      EXPECT_EQ(rho, nullptr);
      continue;
    }
    double values[3];
    rho->Evaluate(0.0, values);
    EXPECT_EQ(values[0], 0.0) << name;
    for (double s = 1e-8; s < 1e4; s *= 3) {
      rho->Evaluate(s, values);
      EXPECT_GE(values[0], s * values[1] * (1 - 1e-12)) << name << " at " << s;
      EXPECT_LE(values[2], 0.0) << name << " at " << s;
    }
  }
}

TEST(InitialWeights, OutputsStartAtTheMeanOfTheTargets) {
  const NetworkShape shape(Encoding::kMultiscale, {4}, Activation::kTanh);
  const auto samples = DrawSamples(*MakeBuiltin("spectralon"), SampleSet::kTraining,
                                   Sampling::kUniform, 100, /*seed=*/1);
  const std::vector<double> weights = InitialWeights(shape, samples, /*seed=*/1);
  for (int c = 1; c <= 3; ++c) {
    EXPECT_NEAR(weights[shape.offset(1) + 5 * c - 1], std::log1p(0.99 / kPi), 1e-12);
  }
  EXPECT_EQ(weights, InitialWeights(shape, samples, /*seed=*/1));
  EXPECT_NE(weights, InitialWeights(shape, samples, /*seed=*/2));
}

TEST(InitialWeights, NbrdfsAreSmallWithBiasesOf0) {
  const NetworkShape shape(Encoding::kCartesian, {21, 21}, Activation::kRelu);
  const std::vector<double> weights = InitialWeights(shape, {}, /*seed=*/1, Initialization::kNbrdf);
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  EXPECT_NEAR(*least, -0.05, 1e-3);
  EXPECT_NEAR(*most, 0.05, 1e-3);
  for (int layer = 0; layer < shape.num_layers(); ++layer) {
    const int columns = shape.in(layer) + 1;
    for (int o = 0; o < shape.out(layer); ++o) {
      EXPECT_EQ(weights[shape.offset(layer) + (o + 1) * columns - 1], 0.0);
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
