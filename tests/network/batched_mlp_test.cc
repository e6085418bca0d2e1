// Batched passes against the scalar network, with doubles and with full jets.
#include "network/batched_mlp.h"

#include <ceres/jet.h>

#include "network/random_network.h"
#include "pbnbrdf/network/mlp.h"

namespace pbnbrdf {
namespace {

constexpr int kBatch = kernels::kBatch;
constexpr int kChannels = NetworkShape::kChannels;
// 6-5-4-3: 35 + 24 + 15.
constexpr int kWeights = 74;
using WeightJet = ceres::Jet<double, kWeights>;

class BatchedMlpTest : public testing::TestWithParam<Activation> {
 protected:
  NetworkShape shape_{Encoding::kMultiscale, {5, 4}, GetParam()};
  std::vector<double> weights_ = RandomWeights(shape_, 0.7, /*seed=*/1);
  std::vector<double> input_ = RandomNumbers(kEncodedSize * kBatch, -1.0, 1.0, /*seed=*/2);

  std::array<double, kEncodedSize> Input(int n) const {
    std::array<double, kEncodedSize> x;
    for (int i = 0; i < kEncodedSize; ++i) x[i] = input_[i * kBatch + n];
    return x;
  }
};

TEST_P(BatchedMlpTest, ForwardIsTheScalarNetwork) {
  BatchedMlp<double> mlp(shape_, 0);
  mlp.Forward(weights_.data(), input_.data());
  const std::vector<const double*> blocks = shape_.Blocks<const double>(weights_.data());
  for (int n = 0; n < kBatch; ++n) {
    double z[kChannels];
    EvaluateMlp(shape_, Input(n).data(), blocks.data(), z);
    for (int c = 0; c < kChannels; ++c) EXPECT_NEAR(mlp.output()[c * kBatch + n], z[c], 1e-13);
  }
}

TEST_P(BatchedMlpTest, BackwardGivesTheGradientOfJets) {
  ASSERT_EQ(shape_.num_weights(), kWeights);
  constexpr int kRows = 2;
  const auto seeds = RandomNumbers(kRows * kChannels * kBatch, -1.0, 1.0, /*seed=*/3);
  BatchedMlp<double> mlp(shape_, kRows);
  mlp.Forward(weights_.data(), input_.data());
  for (int r = 0; r < kRows; ++r) {
    std::copy_n(&seeds[r * kChannels * kBatch], kChannels * kBatch, mlp.output_gradient(r));
  }
  mlp.Backward(weights_.data());
  mlp.TransposeInputs();

  std::vector<WeightJet> jets;
  for (int i = 0; i < kWeights; ++i) jets.emplace_back(weights_[i], i);
  const std::vector<const WeightJet*> blocks = shape_.Blocks<const WeightJet>(jets.data());
  for (int n = 0; n < kBatch; n += 17) {
    WeightJet z[kChannels];
    EvaluateMlp(shape_, Input(n).data(), blocks.data(), z);
    for (int r = 0; r < kRows; ++r) {
      WeightJet sum(0.0);
      for (int c = 0; c < kChannels; ++c) sum += seeds[(r * kChannels + c) * kBatch + n] * z[c];
      for (int l = 0, i = 0; l < shape_.num_layers(); ++l) {
        const int columns = shape_.in(l) + 1;
        const double* input = mlp.layer_input(l) + n * kernels::Padded(columns);
        const double* delta = mlp.delta(l) + r * shape_.out(l) * kBatch + n;
        for (int o = 0; o < shape_.out(l); ++o) {
          for (int j = 0; j < columns; ++j, ++i) {
            EXPECT_NEAR(delta[o * kBatch] * input[j], sum.v[i], 1e-12) << "weight " << i;
          }
        }
      }
    }
  }
}

TEST_P(BatchedMlpTest, WeightGradientIsTheSumOverSamples) {
  constexpr int kRows = 2, kRow = 1;
  BatchedMlp<double> mlp(shape_, kRows);
  mlp.Forward(weights_.data(), input_.data());
  for (int r = 0; r < kRows; ++r) {
    const auto seeds = RandomNumbers(kChannels * kBatch, -1.0, 1.0, /*seed=*/4 + r);
    std::copy(seeds.begin(), seeds.end(), mlp.output_gradient(r));
  }
  mlp.Backward(weights_.data());
  mlp.TransposeInputs();
  std::vector<double> gradient(kWeights, 0.25), expected(kWeights, 0.25);
  mlp.AddWeightGradient(kRow, gradient.data());
  for (int l = 0; l < shape_.num_layers(); ++l) {
    const int columns = shape_.in(l) + 1;
    for (int n = 0; n < kBatch; ++n) {
      const double* input = mlp.layer_input(l) + n * kernels::Padded(columns);
      const double* delta = mlp.delta(l) + kRow * shape_.out(l) * kBatch + n;
      for (int i = 0; i < shape_.block_size(l); ++i) {
        expected[shape_.offset(l) + i] += delta[i / columns * kBatch] * input[i % columns];
      }
    }
  }
  for (int i = 0; i < kWeights; ++i) EXPECT_NEAR(gradient[i], expected[i], 1e-10) << i;
}

TEST_P(BatchedMlpTest, SingleAgreesWithDouble) {
  BatchedMlp<double> reference(shape_, 0);
  reference.Forward(weights_.data(), input_.data());
  const std::vector<float> weights(weights_.begin(), weights_.end());
  const std::vector<float> input(input_.begin(), input_.end());
  BatchedMlp<float> mlp(shape_, 0);
  mlp.Forward(weights.data(), input.data());
  for (int i = 0; i < kChannels * kBatch; ++i) {
    EXPECT_NEAR(mlp.output()[i], reference.output()[i], 1e-5);
  }
}

// As a network of three equal outputs, whose gradients add up.
TEST_P(BatchedMlpTest, OneOutputStandsForAllChannels) {
  const NetworkShape one(Encoding::kMultiscale, {5, 4}, GetParam(), 1);
  EXPECT_EQ(one.num_weights(), kWeights - 2 * 5);
  const int last = shape_.offset(2);
  const std::vector<double> weights(weights_.begin(), weights_.begin() + one.num_weights());
  std::vector<double> tied = weights;
  for (int c = 1; c < kChannels; ++c) {
    tied.insert(tied.end(), weights.begin() + last, weights.end());
  }
  const auto gradients = RandomNumbers(2 * kChannels * kBatch, -1.0, 1.0, /*seed=*/3);
  const auto run = [&](const NetworkShape& shape, const std::vector<double>& w, int row) {
    BatchedMlp<double> mlp(shape, 2);
    mlp.Forward(w.data(), input_.data());
    for (int r = 0; r < 2; ++r) {
      std::copy_n(&gradients[r * kChannels * kBatch], kChannels * kBatch, mlp.output_gradient(r));
    }
    mlp.Backward(w.data());
    std::vector<double> gradient(shape.num_weights());
    mlp.AddWeightGradient(row, gradient.data());
    gradient.insert(gradient.end(), mlp.output(), mlp.output() + kChannels * kBatch);
    return gradient;
  };
  for (int row : {0, 1}) {
    const std::vector<double> found = run(one, weights, row), expected = run(shape_, tied, row);
    for (int i = 0; i < last; ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
    for (int i = last; i < last + 5; ++i) {
      EXPECT_NEAR(found[i], expected[i] + expected[i + 5] + expected[i + 10], 1e-12) << i;
    }
    for (int k = 0; k < kChannels * kBatch; ++k) {
      EXPECT_EQ(found[one.num_weights() + k], expected[kWeights + k]) << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Activations, BatchedMlpTest,
                         testing::Values(Activation::kTanh, Activation::kRelu),
                         [](const auto& test) {
                           return std::string(NameOf(kActivations, test.param));
                         });

}  // namespace
}  // namespace pbnbrdf
