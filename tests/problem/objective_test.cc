// The fast path against the reference: cost, J'r and J'J of the batched objective against those of
// jets through the whole network, robust loss included.
#include "pbnbrdf/problem/objective.h"

#include <ceres/crs_matrix.h>
#include <ceres/problem.h>
#include <tbb/task_arena.h>

#include <Eigen/Core>

#include "network/random_network.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/network/mlp.h"
#include "pbnbrdf/problem/ceres_problem.h"
#include "pbnbrdf/problem/energy_strata.h"
#include "pbnbrdf/residuals/chromaticity_residual.h"
#include "pbnbrdf/residuals/energy_residual.h"
#include "pbnbrdf/residuals/log_residual.h"
#include "pbnbrdf/residuals/network_residual.h"
#include "problem/encoded_samples.h"

namespace pbnbrdf {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Case {
  std::string name;
  FitProblem problem;
  std::vector<double> weights;
};

std::vector<BrdfSample> Samples(const FitProblem& problem) {
  return DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining, problem.sampling.angles,
                     problem.sampling.samples, problem.sampling.seed);
}

FitProblem SmallProblem() {
  FitProblem problem;
  problem.network.hidden = {5, 4};
  problem.sampling.samples = 150;  // a full batch and a part of one
  problem.terms.SetWeight("energy", 0.0);
  problem.terms.energy_strata = 4;
  problem.terms.energy_theta = 8;
  problem.terms.energy_phi = 6;
  problem.terms.loss = Loss::kL2;
  return problem;
}

Case MakeCase(const std::string& name, FitProblem problem, double output_bias = 0.5,
              void (*change)(const NetworkShape&, std::vector<double>*) = nullptr) {
  const NetworkShape shape = problem.Shape();
  std::vector<double> weights = RandomWeights(shape, 0.8, /*seed=*/11);
  for (int c = 1; c <= shape.num_outputs(); ++c) {
    const int last = shape.num_layers() - 1;
    weights[shape.offset(last) + c * (shape.in(last) + 1) - 1] = output_bias;
  }
  if (change != nullptr) change(shape, &weights);
  return {name, problem, weights};
}

// The first hidden layer's unit 1 never fires, its unit 2 has no way out.
void KillUnits(const NetworkShape& shape, std::vector<double>* weights) {
  const int columns = shape.in(0) + 1;
  (*weights)[1 * columns + columns - 1] = -100.0;
  for (int o = 0; o < shape.out(1); ++o) {
    (*weights)[shape.offset(1) + o * (shape.in(1) + 1) + 2] = 0.0;
  }
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  FitProblem problem = SmallProblem();
  cases.push_back(MakeCase("Log", problem));
  problem.network.activation = Activation::kRelu;
  cases.push_back(MakeCase("Relu", problem));
  cases.push_back(MakeCase("DeadUnitsRelu", problem, 0.5, KillUnits));
  problem.network.activation = Activation::kTanh;
  cases.push_back(MakeCase("DeadUnitsTanh", problem, 0.5, KillUnits));
  problem.terms.SetWeight("chromaticity", 0.3);
  cases.push_back(MakeCase("LogAndChromaticity", problem));
  problem.terms.SetWeight("log", 0.0);
  cases.push_back(MakeCase("Chromaticity", problem));
  problem = SmallProblem();
  problem.terms.SetWeight("energy", 2.0);
  cases.push_back(MakeCase("Energy", problem));
  // Channel values around 0: some outputs are clamped in the energy term, others not.
  cases.push_back(MakeCase("ClampedOutputs", problem, -0.1));
  problem.terms.SetWeight("chromaticity", 0.3);
  cases.push_back(MakeCase("AllTerms", problem));
  problem.terms.loss = Loss::kSoftL1;
  problem.terms.loss_scale = 0.1;
  cases.push_back(MakeCase("AllTermsSoftL1", problem));
  problem.network.channels = 1;
  cases.push_back(MakeCase("OneOutput", problem));
  problem.network.channels = 3;
  problem.network.encoding = Encoding::kReciprocal;
  cases.push_back(MakeCase("Reciprocal", problem));
  problem.network.hidden = {21, 21};
  problem.sampling.samples = 40;
  cases.push_back(MakeCase("Published675Weights", problem));
  problem.network.hidden = {3, 9, 5};
  cases.push_back(MakeCase("ThreeHiddenLayers", problem));
  return cases;
}

// By jets through the whole network.
struct Reference {
  Reference(const FitProblem& description, std::vector<double> weights) {
    ceres::Problem problem;
    AddAutodiff(description, Samples(description), EqualStrata(description), weights.data(),
                &problem);
    std::vector<double> values;
    ceres::CRSMatrix crs;
    EXPECT_TRUE(problem.Evaluate({}, &at.cost, &values, &at.gradient, &crs));
    residuals = Eigen::Map<Eigen::VectorXd>(values.data(), crs.num_rows);
    jacobian = RowMajor::Zero(crs.num_rows, crs.num_cols);
    for (int row = 0; row < crs.num_rows; ++row) {
      for (int k = crs.rows[row]; k < crs.rows[row + 1]; ++k) {
        jacobian(row, crs.cols[k]) += crs.values[k];
      }
    }
    const RowMajor hessian = jacobian.transpose() * jacobian;
    at.hessian.assign(hessian.data(), hessian.data() + hessian.size());
  }

  Linearization at;
  Eigen::VectorXd residuals;
  RowMajor jacobian;
};

// The largest deviations, in units of what rounding is relative to: the cost; |J_i| |r|; |J_i|
// |J_j|.
struct Deviation {
  double cost = 0.0, gradient = 0.0, hessian = 0.0;
};

Deviation Compare(const Linearization& a, const Linearization& b) {
  const std::size_t p = b.gradient.size();
  const auto norm = [&](std::size_t i) { return std::sqrt(b.hessian[i * p + i]); };
  Deviation worst;
  worst.cost = std::abs(a.cost - b.cost) / b.cost;
  double largest = 0.0;
  for (std::size_t i = 0; i < p; ++i) largest = std::max(largest, norm(i));
  for (std::size_t i = 0; i < p; ++i) {
    // A weight that moves nothing may be off by rounding against the others.
    const double scale_i = std::max(norm(i), 1e-6 * largest);
    worst.gradient = std::max(worst.gradient, std::abs(a.gradient[i] - b.gradient[i]) /
                                                  (scale_i * std::sqrt(2.0 * b.cost)));
    for (std::size_t j = 0; j < p; ++j) {
      const double scale = scale_i * std::max(norm(j), 1e-6 * largest);
      worst.hessian =
          std::max(worst.hessian, std::abs(a.hessian[i * p + j] - b.hessian[i * p + j]) / scale);
    }
  }
  return worst;
}

class ObjectiveTest : public testing::TestWithParam<Case> {
 protected:
  static Linearization Fast(Precision precision, int threads = 2) {
    const FitProblem& problem = GetParam().problem;
    const auto objective = MakeObjective(problem, precision, Samples(problem));
    Linearization at;
    tbb::task_arena arena(threads);
    EXPECT_TRUE(
        arena.execute([&] { return objective->Linearize(GetParam().weights.data(), &at); }));
    EXPECT_NEAR(objective->Cost(GetParam().weights.data()), at.cost, 1e-12 * at.cost);
    return at;
  }

  static void ExpectAgreement(Precision precision, double tolerance) {
    const Deviation worst =
        Compare(Fast(precision), Reference(GetParam().problem, GetParam().weights).at);
    RecordProperty("worst_cost", std::to_string(worst.cost / tolerance));
    RecordProperty("worst_gradient", std::to_string(worst.gradient / tolerance));
    RecordProperty("worst_hessian", std::to_string(worst.hessian / tolerance));
    EXPECT_LE(worst.cost, tolerance);
    EXPECT_LE(worst.gradient, tolerance);
    EXPECT_LE(worst.hessian, tolerance);
  }
};

TEST_P(ObjectiveTest, DoubleAgreesWithJets) { ExpectAgreement(Precision::kDouble, 1e-10); }

TEST_P(ObjectiveTest, SingleAgreesWithJets) { ExpectAgreement(Precision::kSingle, 1e-4); }

TEST_P(ObjectiveTest, SameBitsForOneAndTwoThreads) {
  const Linearization one = Fast(Precision::kSingle, 1), two = Fast(Precision::kSingle, 2);
  EXPECT_EQ(one.cost, two.cost);
  EXPECT_EQ(one.gradient, two.gradient);
  EXPECT_EQ(one.hessian, two.hessian);
}

TEST_P(ObjectiveTest, GradientAloneIsTheSame) {
  const FitProblem& problem = GetParam().problem;
  const auto objective = MakeObjective(problem, Precision::kDouble, Samples(problem));
  const double* weights = GetParam().weights.data();
  Linearization at;
  ASSERT_TRUE(objective->Linearize(weights, &at));
  Linearization alone = at;
  ASSERT_TRUE(objective->Gradient(weights, &alone.cost, alone.gradient.data()));
  EXPECT_LE(Compare(alone, at).cost, 1e-12);
  EXPECT_LE(Compare(alone, at).gradient, 1e-12);
}

TEST_P(ObjectiveTest, CurvatureMayBeInDoubleAlone) {
  FitProblem problem = GetParam().problem;
  problem.terms.SetWeight("energy", 0.0);  // whose passes stay in single precision
  const auto objective = MakeObjective(problem, Precision::kSingle, Samples(problem));
  objective->SumCurvatureInDouble();
  Linearization at;
  ASSERT_TRUE(objective->Linearize(GetParam().weights.data(), &at));
  EXPECT_LE(Compare(at, Reference(problem, GetParam().weights).at).hessian, 1e-10);
}

TEST_P(ObjectiveTest, CurveAgreesWithSecondDifferencesOfJets) {
  FitProblem problem = GetParam().problem;
  const std::vector<double>& weights = GetParam().weights;
  problem.terms.SetWeight("energy", 0.0);  // of which Curve takes no notice
  problem.terms.loss = Loss::kL2;          // for jets would differentiate the robust weights, too
  const std::vector<double> direction = RandomWeights(problem.Shape(), 0.5, /*seed=*/5);
  const auto residuals_at = [&](double step) {
    std::vector<double> moved = weights;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += step * direction[i];
    return Reference(problem, moved).residuals;
  };
  const double h = 2e-3;
  const Reference here(problem, weights);
  const Eigen::VectorXd second =
      (residuals_at(h) - 2.0 * here.residuals + residuals_at(-h)) / (h * h);
  const Eigen::VectorXd expected = here.jacobian.transpose() * second;
  const auto curve = MakeObjective(problem, Precision::kSingle, Samples(problem))
                         ->Curve(weights.data(), direction.data(), {});
  const Eigen::Map<const Eigen::VectorXd> actual(curve.data(), expected.size());
  EXPECT_LE((actual - expected).norm(), 1e-4 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(Cases, ObjectiveTest, testing::ValuesIn(Cases()),
                         [](const auto& test) { return test.param.name; });

TEST(Objective, ManySamplesGiveTheSameBitsForOneAndTwoThreads) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 5000;
  const auto objective = MakeObjective(problem, Precision::kSingle, Samples(problem));
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/3);
  Linearization at[2];
  for (int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { objective->Linearize(weights.data(), &at[threads - 1]); });
  }
  EXPECT_EQ(at[0].cost, at[1].cost);
  EXPECT_EQ(at[0].gradient, at[1].gradient);
  EXPECT_EQ(at[0].hessian, at[1].hessian);
}

TEST(Objective, SaysWhenItIsNotFinite) {
  const FitProblem problem = SmallProblem();
  const auto objective = MakeObjective(problem, Precision::kSingle, Samples(problem));
  std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/3);
  weights.back() = 1e4;  // expm1(1e4) is infinite
  Linearization at;
  EXPECT_FALSE(objective->Linearize(weights.data(), &at));
  EXPECT_FALSE(std::isfinite(objective->Cost(weights.data())));
}

// The papers' own sum from the functors of the terms.
double AbsoluteLoss(const FitProblem& problem, const std::vector<double>& weights) {
  const NetworkShape shape = problem.Shape();
  const auto blocks = shape.Blocks<const double>(weights.data());
  const auto sum_of = [&](auto term, const std::vector<DirectionPair>& pairs) {
    std::vector<std::array<double, kEncodedSize>> inputs;
    for (const DirectionPair& pair : pairs) inputs.push_back(Encode(shape.encoding(), pair));
    double r[decltype(term)::kNumResiduals], sum = 0.0;
    EXPECT_TRUE(NetworkResidual(shape, inputs, term)(blocks.data(), r));
    for (double value : r) sum += std::abs(value);
    return sum;
  };
  double loss = 0.0;
  for (const BrdfSample& s : Samples(problem)) {
    const double cos_i = CosI(s.pair);
    loss += problem.terms.Weight("log") / 3.0 * sum_of(LogResidual(s.value, cos_i), {s.pair});
    loss += problem.terms.Weight("chromaticity") *
            sum_of(ChromaticityResidual(s.value, cos_i), {s.pair});
  }
  loss /= static_cast<double>(problem.sampling.samples);
  const std::vector<EnergyStratum> strata = EqualStrata(problem);
  for (std::size_t k = 0; k < strata.size() && problem.terms.Weight("energy") > 0.0; ++k) {
    std::vector<DirectionPair> pairs;
    std::vector<double> node_weights;
    for (const AlbedoNode& node : QuadratureOfStratum(problem, k).Nodes(strata[k].wi)) {
      pairs.push_back(node.pair);
      node_weights.push_back(node.weight);
    }
    // The residual carries the square root of its solid angle.
    loss += problem.terms.Weight("energy") * strata[k].solid_angle / 3.0 *
            sum_of(EnergyResidual(/*solid_angle=*/1.0, node_weights), pairs);
  }
  return loss;
}

TEST_P(ObjectiveTest, AbsoluteLossIsThePapersSumAndItsGradient) {
  FitProblem problem = GetParam().problem;
  problem.terms.loss = Loss::kAbsolute;
  const auto objective = MakeObjective(problem, Precision::kDouble, Samples(problem));
  std::vector<double> weights = GetParam().weights;
  double cost;
  std::vector<double> gradient(weights.size());
  ASSERT_TRUE(objective->Gradient(weights.data(), &cost, gradient.data()));
  EXPECT_NEAR(cost, AbsoluteLoss(problem, weights), 1e-10 * cost);
  EXPECT_NEAR(cost, objective->Cost(weights.data()), 1e-12 * cost);
  constexpr double kStep = 1e-7;
  int kinks = 0;  // between the two points
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto cost_at = [&](double step) {
      std::vector<double> moved = weights;
      moved[i] += step;
      return objective->Cost(moved.data());
    };
    const double above = cost_at(kStep) - cost, below = cost - cost_at(-kStep);
    if (std::abs(above - below) > 1e-3 * kStep) {
      ++kinks;
      continue;
    }
    EXPECT_NEAR(gradient[i], 0.5 * (above + below) / kStep, 1e-5 * (1.0 + std::abs(gradient[i])))
        << "weight " << i;
  }
  EXPECT_LT(kinks, 3);
}

TEST(Objective, MeanAbsLogErrorIsThatOfEquation6) {
  const FitProblem problem = SmallProblem();
  const std::vector<BrdfSample> samples = Samples(problem);
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/3);
  const NetworkShape shape = problem.Shape();
  const auto blocks = shape.Blocks<const double>(weights.data());
  double sum = 0.0;
  for (const BrdfSample& s : samples) {
    double z[3];
    EvaluateMlp(shape, Encode(shape.encoding(), s.pair).data(), blocks.data(), z);
    for (int c = 0; c < 3; ++c) {
      const double f = std::max(0.0, std::expm1(z[c]));
      sum += std::abs(std::log1p(s.value[c] * s.pair.wi.z) - std::log1p(f * s.pair.wi.z));
    }
  }
  EXPECT_NEAR(MakeObjective(problem, Precision::kSingle, samples)->MeanAbsLogError(weights.data()),
              sum / (3.0 * static_cast<double>(samples.size())), 1e-6);
}

TEST(Objective, CurvatureOfPartsAddsUpToThatOfAll) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 1000;  // 8 batches, the last one not full
  const auto objective = MakeObjective(problem, Precision::kDouble, Samples(problem));
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/11);
  Linearization all;
  ASSERT_TRUE(objective->Linearize(weights.data(), &all));
  const double samples_of_part[] = {3 * 128.0, 2 * 128.0 + 104.0, 2 * 128.0};
  std::vector<double> sum(all.hessian.size());
  for (std::size_t part = 0; part < 3; ++part) {
    Linearization at;
    // Parts come round again.
    ASSERT_TRUE(objective->Linearize(weights.data(), {.index = part + 30, .count = 3}, &at));
    EXPECT_NEAR(at.cost, all.cost, 1e-12 * all.cost);
    for (std::size_t i = 0; i < all.gradient.size(); ++i) {
      EXPECT_NEAR(at.gradient[i], all.gradient[i], 1e-12);
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += samples_of_part[part] / 1000.0 * at.hessian[i];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], all.hessian[i], 1e-12);
}

// A weight of 1 beside one of 1/2, or of 1/4, is two copies of the sample, or four.
TEST(Objective, AWeightIsANumberOfCopies) {
  for (const Loss loss : {Loss::kL2, Loss::kSoftL1, Loss::kAbsolute}) {
    FitProblem problem = SmallProblem();
    problem.terms.SetWeight("chromaticity", 0.3);
    problem.terms.loss = loss;
    std::vector<BrdfSample> weighted = Samples(problem), copies;
    for (std::size_t n = 0; n < weighted.size(); ++n) {
      const int count = 1 << n % 3;
      copies.insert(copies.end(), static_cast<std::size_t>(count), weighted[n]);
      weighted[n].weight = count / 4.0;
    }
    std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/3);
    const auto a = MakeObjective(problem, Precision::kDouble, weighted);
    const auto b = MakeObjective(problem, Precision::kDouble, copies);
    const double cost = b->Cost(weights.data());
    EXPECT_NEAR(a->Cost(weights.data()), cost, 1e-12 * cost);
    std::vector<double> of_a(weights.size()), of_b(weights.size());
    double unused;
    ASSERT_TRUE(a->Gradient(weights.data(), &unused, of_a.data()));
    ASSERT_TRUE(b->Gradient(weights.data(), &unused, of_b.data()));
    for (std::size_t k = 0; k < of_a.size(); ++k) EXPECT_NEAR(of_a[k], of_b[k], 1e-12) << k;
    if (loss == Loss::kAbsolute) continue;
    Linearization at_a, at_b;
    ASSERT_TRUE(a->Linearize(weights.data(), &at_a));
    ASSERT_TRUE(b->Linearize(weights.data(), &at_b));
    const Deviation worst = Compare(at_a, at_b);
    EXPECT_LE(std::max({worst.cost, worst.gradient, worst.hessian}), 1e-10);
    ceres::Problem ceres_problem;
    AddAutodiff(problem, weighted, {}, weights.data(), &ceres_problem);
    double ceres_cost = 0.0;
    ASSERT_TRUE(ceres_problem.Evaluate({}, &ceres_cost, nullptr, nullptr, nullptr));
    EXPECT_NEAR(ceres_cost, cost, 1e-12 * cost);
  }
}

TEST(Objective, GrownIsTheSameToTheBitAsMadeOfAll) {
  FitProblem problem = SmallProblem();
  problem.sampling.samples = 1000;
  problem.terms.SetWeight("chromaticity", 0.3);
  const EncodedSamples samples(problem.Shape().encoding(), Samples(problem));
  const auto all = MakeObjective(problem, Precision::kSingle, samples, 1000);
  const auto grown = MakeObjective(problem, Precision::kSingle, samples, 100);
  EXPECT_EQ(grown->num_samples(), 100u);
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/11);
  EXPECT_NE(grown->Cost(weights.data()), all->Cost(weights.data()));
  grown->Grow(300);
  grown->Grow(1000);
  Linearization of_all, of_grown;
  ASSERT_TRUE(all->Linearize(weights.data(), &of_all));
  ASSERT_TRUE(grown->Linearize(weights.data(), &of_grown));
  EXPECT_EQ(of_grown.cost, of_all.cost);
  EXPECT_EQ(of_grown.gradient, of_all.gradient);
  EXPECT_EQ(of_grown.hessian, of_all.hessian);
  EXPECT_EQ(grown->MeanAbsLogError(weights.data()), all->MeanAbsLogError(weights.data()));
}

TEST(Objective, MorePartsThanBatchesAreOneBatchEach) {
  const FitProblem problem = SmallProblem();
  const auto objective = MakeObjective(problem, Precision::kSingle, Samples(problem));
  const std::vector<double> weights = RandomWeights(problem.Shape(), 0.8, /*seed=*/11);
  Linearization two, many;
  ASSERT_TRUE(objective->Linearize(weights.data(), {.index = 1, .count = 2}, &two));
  ASSERT_TRUE(objective->Linearize(weights.data(), {.index = 1, .count = 100}, &many));
  EXPECT_EQ(two.hessian, many.hessian);
}

}  // namespace
}  // namespace pbnbrdf
