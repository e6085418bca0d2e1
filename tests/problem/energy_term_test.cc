#include "problem/energy_term.h"

#include "brdf/direction_pairs.h"
#include "network/random_network.h"

namespace pbnbrdf {
namespace {

// A network whose reflectance is `albedo` / pi everywhere.
std::vector<double> Lambertian(const NetworkShape& shape, double albedo) {
  std::vector<double> weights(shape.num_weights(), 0.0);
  const int last = shape.num_layers() - 1, in = shape.in(last);
  for (int c = 0; c < 3; ++c) {
    weights[shape.offset(last) + c * (in + 1) + in] = std::log1p(albedo / kPi);
  }
  return weights;
}

FitProblem SmallProblem() {
  FitProblem problem;
  problem.network.hidden = {3};
  problem.terms.energy_strata = 4;
  return problem;
}

// With the problem's weight and equal strata.
EnergyTerm<double> TermOf(const FitProblem& problem) {
  EnergyTerm<double> term(problem);
  term.Set(problem.terms.EnergyWeight(), EqualStrata(problem));
  return term;
}

Linearization LinearizeAt(const std::vector<double>& weights, EnergyTerm<double>* term) {
  Linearization at;
  at.gradient.assign(weights.size(), 0.0);
  at.hessian.assign(weights.size() * weights.size(), 0.0);
  term->Linearize(weights.data(), &at);
  return at;
}

TEST(EnergyTerm, OfALambertianIsTheExcessOverTheHemisphere) {
  FitProblem problem = SmallProblem();
  problem.terms.SetWeight("energy", 3.0);
  EnergyTerm<double> term = TermOf(problem);
  const auto cost_at = [&](double albedo) {
    return term.Cost(Lambertian(problem.Shape(), albedo).data());
  };
  // Three channels, 2 pi sr, 1/2 weight excess^2.
  EXPECT_NEAR(cost_at(1.2), 3.0 * 0.5 * 3.0 * 2.0 * kPi * 0.2 * 0.2, 2e-2);
  EXPECT_EQ(cost_at(0.99), 0.0);
}

TEST(EnergyTerm, ALowerLimitMakesAnAlbedoBelow1Cost) {
  const FitProblem problem = SmallProblem();
  std::vector<EnergyStratum> strata = EqualStrata(problem);
  strata[2].limit = {0.9, 1.0, 1.0};
  EnergyTerm<double> term(problem);
  term.Set(1.0, strata);
  const std::vector<double> weights = Lambertian(problem.Shape(), 0.95);
  EXPECT_NEAR(term.Cost(weights.data()), 0.5 * 2.0 * kPi / 4.0 * 0.05 * 0.05, 2e-4);
  const Linearization at = LinearizeAt(weights, &term);
  const int bias = problem.Shape().num_weights() - 9;  // of red, the first of 3 rows of 4
  EXPECT_GT(at.gradient[bias], 0.0);
  EXPECT_EQ(at.gradient[bias + 4], 0.0);
}

TEST(EnergyTerm, GradientIsThatOfTheCost) {
  const FitProblem problem = SmallProblem();
  EnergyTerm<double> term = TermOf(problem);
  std::vector<double> weights = RandomWeights(problem.Shape(), 0.5, /*seed=*/4);
  for (int c = 1; c <= 3; ++c) weights[weights.size() - 4 * c + 3] += 1.0;  // bright
  const Linearization at = LinearizeAt(weights, &term);
  ASSERT_GT(at.cost, 0.0);
  EXPECT_NEAR(at.cost, term.Cost(weights.data()), 1e-12 * at.cost);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    constexpr double kStep = 1e-6;
    std::vector<double> above = weights, below = weights;
    above[i] += kStep;
    below[i] -= kStep;
    const double slope = (term.Cost(above.data()) - term.Cost(below.data())) / (2.0 * kStep);
    EXPECT_NEAR(at.gradient[i], slope, 1e-5 * (1.0 + std::abs(slope))) << i;
  }
}

TEST(EnergyTerm, LooksAgainAtStrataThatWereFarBelow1) {
  const FitProblem problem = SmallProblem();
  EnergyTerm<double> term = TermOf(problem);
  const std::vector<double> dark = Lambertian(problem.Shape(), 0.5);
  const std::vector<double> bright = Lambertian(problem.Shape(), 1.5);
  EXPECT_GT(term.Cost(bright.data()), 0.0);  // nothing is known to be far below yet
  LinearizeAt(dark, &term);
  EXPECT_EQ(term.Cost(bright.data()), 0.0);  // skipped
  EXPECT_EQ(term.work().albedos_skipped, 4);
  for (int k = 1; k < EnergyTerm<double>::kRecheck; ++k) {
    EXPECT_EQ(LinearizeAt(bright, &term).cost, 0.0);
  }
  EXPECT_GT(LinearizeAt(bright, &term).cost, 0.0);
  EXPECT_GT(term.Cost(bright.data()), 0.0);
  EXPECT_EQ(term.work().jacobians, 4);
}

TEST(EnergyTerm, WithoutSkippingAllStrataAreAlwaysSeen) {
  FitProblem problem = SmallProblem();
  problem.terms.energy_skip = false;
  EnergyTerm<double> term = TermOf(problem);
  LinearizeAt(Lambertian(problem.Shape(), 0.5), &term);
  EXPECT_GT(term.Cost(Lambertian(problem.Shape(), 1.5).data()), 0.0);
  EXPECT_EQ(term.work().albedos_skipped, 0);
}

TEST(EnergyTerm, KeepsTheNodesOfStrataThatStayAndStartsAfreshAsToWhatIsFarBelow1) {
  const FitProblem problem = SmallProblem();
  EnergyTerm<double> term = TermOf(problem);
  const std::vector<double> bright = Lambertian(problem.Shape(), 1.5);
  const double cost = term.Cost(bright.data());
  LinearizeAt(Lambertian(problem.Shape(), 0.5), &term);
  EXPECT_EQ(term.Cost(bright.data()), 0.0);
  std::vector<EnergyStratum> strata = EqualStrata(problem);
  term.Set(1.0, strata);
  EXPECT_EQ(term.Cost(bright.data()), cost);
  // A term that was never set to anything else has the same cost, whatever stood in a stratum's place.
  strata.pop_back();
  strata[1].wi = FromSpherical(0.3, 0.0);
  strata.push_back({FromSpherical(0.8, 0.0), 0.5});
  term.Set(2.0, strata);
  EnergyTerm<double> afresh(problem);
  afresh.Set(2.0, strata);
  EXPECT_EQ(term.Cost(bright.data()), afresh.Cost(bright.data()));
  EXPECT_NE(term.Cost(bright.data()), 2.0 * cost);
  term.Set(0.0, {});
  EXPECT_EQ(term.Cost(bright.data()), 0.0);
}

TEST(EqualStrata, ShareTheHemisphere) {
  FitProblem problem;
  for (Encoding encoding : {Encoding::kMerl, Encoding::kAnisotropic}) {
    problem.network.encoding = encoding;
    const auto strata = EqualStrata(problem);
    EXPECT_EQ(strata.size(), encoding == Encoding::kMerl ? 16u : 16u * 8u);
    double solid_angle = 0.0;
    for (const EnergyStratum& stratum : strata) {
      solid_angle += stratum.solid_angle;
      EXPECT_NEAR(Length(stratum.wi), 1.0, 1e-12);
      EXPECT_GT(stratum.wi.z, 0.0);
    }
    EXPECT_NEAR(solid_angle, 2.0 * kPi, 1e-12);
  }
}

}  // namespace
}  // namespace pbnbrdf
