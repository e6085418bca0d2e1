#include "problem/condensed_cost_function.h"

#include <ceres/problem.h>

#include <Eigen/Core>

#include "network/random_network.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/problem/ceres_problem.h"

namespace pbnbrdf {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class CondensedTest : public testing::TestWithParam<Activation> {
 protected:
  CondensedTest() {
    problem_.network.hidden = {5, 4};
    problem_.network.activation = GetParam();
    problem_.sampling.samples = 200;
    problem_.terms.SetWeight("chromaticity", 0.2);
    problem_.terms.energy_strata = 4;
    problem_.terms.energy_theta = 8;
    problem_.terms.energy_phi = 6;
    problem_.terms.loss_scale = 0.1;
    samples_ =
        DrawSamples(*MakeBuiltin("satin-gold"), SampleSet::kTraining, problem_.sampling.angles,
                    problem_.sampling.samples, problem_.sampling.seed);
    objective_ = MakeObjective(problem_, Precision::kDouble, samples_);
    weights_ = RandomWeights(problem_.Shape(), 0.8, /*seed=*/2);
  }

  // The block's residuals and its Jacobian for all weights.
  void Evaluate(Eigen::VectorXd* residuals, RowMajor* jacobian) {
    const NetworkShape shape = problem_.Shape();
    const CondensedCostFunction block(objective_.get());
    residuals->resize(block.num_residuals());
    *jacobian = RowMajor::Zero(block.num_residuals(), shape.num_weights());
    std::vector<std::vector<double>> storage;
    std::vector<double*> jacobians;
    for (int l = 0; l < shape.num_layers(); ++l) {
      storage.emplace_back(block.num_residuals() * shape.block_size(l), std::nan(""));
      jacobians.push_back(storage.back().data());
    }
    const auto blocks = shape.Blocks<const double>(weights_.data());
    ASSERT_TRUE(block.Evaluate(blocks.data(), residuals->data(), jacobians.data()));
    for (int l = 0; l < shape.num_layers(); ++l) {
      jacobian->middleCols(shape.offset(l), shape.block_size(l)) =
          Eigen::Map<RowMajor>(jacobians[l], block.num_residuals(), shape.block_size(l));
    }
  }

  FitProblem problem_;
  std::vector<BrdfSample> samples_;
  std::unique_ptr<Objective> objective_;
  std::vector<double> weights_;
};

TEST_P(CondensedTest, HasTheNormalEquationsOfTheFullProblem) {
  Linearization at;
  ASSERT_TRUE(objective_->Linearize(weights_.data(), &at));
  Eigen::VectorXd residuals;
  RowMajor jacobian;
  Evaluate(&residuals, &jacobian);
  const int p = problem_.Shape().num_weights();
  const Eigen::Map<RowMajor> hessian(at.hessian.data(), p, p);
  const Eigen::Map<Eigen::VectorXd> gradient(at.gradient.data(), p);
  EXPECT_NEAR(0.5 * residuals.squaredNorm(), at.cost, 1e-10 * at.cost);
  EXPECT_LT((jacobian.transpose() * residuals - gradient).norm(), 1e-10 * gradient.norm());
  EXPECT_LT((jacobian.transpose() * jacobian - hessian).norm(), 1e-10 * hessian.norm());
}

TEST_P(CondensedTest, CeresSeesTheAutodiffProblemsCostAndGradient) {
  ceres::Problem condensed, autodiff;
  AddCondensed(objective_.get(), weights_.data(), &condensed);
  std::vector<double> copy = weights_;
  AddAutodiff(problem_, samples_, EqualStrata(problem_), copy.data(), &autodiff);
  double cost[2];
  std::vector<double> gradient[2];
  ASSERT_TRUE(condensed.Evaluate({}, &cost[0], nullptr, &gradient[0], nullptr));
  ASSERT_TRUE(autodiff.Evaluate({}, &cost[1], nullptr, &gradient[1], nullptr));
  EXPECT_NEAR(cost[0], cost[1], 1e-10 * cost[1]);
  const Eigen::Map<Eigen::VectorXd> a(gradient[0].data(), gradient[0].size());
  const Eigen::Map<Eigen::VectorXd> b(gradient[1].data(), gradient[1].size());
  EXPECT_LT((a - b).norm(), 1e-10 * b.norm());
}

TEST_P(CondensedTest, CostAloneIsTheSame) {
  const CondensedCostFunction block(objective_.get());
  Eigen::VectorXd with, without(block.num_residuals());
  RowMajor jacobian;
  Evaluate(&with, &jacobian);
  const auto blocks = problem_.Shape().Blocks<const double>(weights_.data());
  ASSERT_TRUE(block.Evaluate(blocks.data(), without.data(), nullptr));
  EXPECT_NEAR(with.squaredNorm(), without.squaredNorm(), 1e-12 * with.squaredNorm());
}

TEST_P(CondensedTest, RefusesWhatIsNotFinite) {
  weights_.back() = 1e4;
  const CondensedCostFunction block(objective_.get());
  std::vector<double> residuals(block.num_residuals());
  const auto blocks = problem_.Shape().Blocks<const double>(weights_.data());
  EXPECT_FALSE(block.Evaluate(blocks.data(), residuals.data(), nullptr));
}

INSTANTIATE_TEST_SUITE_P(Activations, CondensedTest,
                         testing::Values(Activation::kTanh, Activation::kRelu),
                         [](const auto& test) {
                           return std::string(NameOf(kActivations, test.param));
                         });

}  // namespace
}  // namespace pbnbrdf
