// NeuralBrdf::SinglePrecision against the same in double, on each instruction set.

#include "brdf/direction_pairs.h"
#include "instruction_sets.h"
#include "network/random_network.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

NeuralBrdf RandomNetwork(Encoding encoding, Activation activation = Activation::kTanh,
                         std::vector<int> hidden = {21, 21}, double scale = 0.7) {
  const NetworkShape shape(encoding, hidden, activation);
  return NeuralBrdf(shape, RandomWeights(shape, scale, /*seed=*/1));
}

std::vector<Rgb> Values(const Brdf& brdf, const std::vector<DirectionPair>& pairs) {
  std::vector<Rgb> values(pairs.size());
  brdf.EvaluateUnclipped(pairs, values);
  return values;
}

// Pairs over the whole sphere: a network goes on below the horizon.
std::vector<DirectionPair> PairsOfTheSphere(std::size_t count) {
  std::vector<DirectionPair> pairs = HardAndRandomPairs(count, /*seed=*/5);
  for (std::size_t n = 0; n < pairs.size(); n += 3) pairs[n].wo.z *= -1.0;
  for (std::size_t n = 0; n < pairs.size(); n += 7) pairs[n].wi.z *= -1.0;
  return pairs;
}

void ExpectAgreement(const NeuralBrdf& network, const std::vector<DirectionPair>& pairs) {
  const std::vector<Rgb> expected = Values(network, pairs);
  const Encoding encoding = network.shape().encoding();
  // The first input is to 1e-4 only.
  const bool bends = encoding == Encoding::kMerl;
  ForEachInstructionSet([&](const char* set) {
    const std::vector<Rgb> values = Values(*network.SinglePrecision(), pairs);
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      for (int c = 0; c < 3; ++c) {
        const double tolerance =
            bends ? 1e-4 * (1.0 + expected[n][c]) : 1e-5 * expected[n][c] + 2e-6;
        ASSERT_NEAR(values[n][c], expected[n][c], tolerance)
            << set << ", " << network.Description() << ", pair " << n;
      }
    }
  });
}

TEST(SinglePrecision, AgreesWithDoublePrecision) {
  const std::vector<DirectionPair> pairs = PairsOfTheSphere(3000);
  for (const auto& [name, encoding] : kEncodings) {
    for (const auto& [activation_name, activation] : kActivations) {
      ExpectAgreement(RandomNetwork(encoding, activation), pairs);
    }
  }
  ExpectAgreement(RandomNetwork(Encoding::kMultiscale, Activation::kTanh, {5}), pairs);
  const NetworkShape one(Encoding::kMerl, {9}, Activation::kTanh, /*outputs=*/1);
  ExpectAgreement(NeuralBrdf(one, RandomWeights(one, 0.7, /*seed=*/1)), pairs);
  ExpectAgreement(RandomNetwork(Encoding::kMultiscale, Activation::kTanh, {1, 40, 7}, 0.3), pairs);
}

TEST(SinglePrecision, AgreesCloseToTheMirrorDirection) {
  std::vector<DirectionPair> pairs;
  for (double offset = 1.0; offset > 1e-12; offset *= 0.7) {
    for (double theta : {0.0, 0.4, 1.3}) {
      pairs.push_back({FromSpherical(theta, 2.0), FromSpherical(theta + offset, 2.0 + kPi)});
      pairs.push_back({FromSpherical(theta, 2.0), FromSpherical(theta, 2.0 + kPi + offset)});
    }
  }
  ExpectAgreement(RandomNetwork(Encoding::kMultiscale), pairs);
  ExpectAgreement(RandomNetwork(Encoding::kAnisotropic), pairs);
}

TEST(SinglePrecision, IsAsIsotropicAsItsEncoding) {
  for (const auto& [name, encoding] : kEncodings) {
    EXPECT_EQ(RandomNetwork(encoding).SinglePrecision()->IsIsotropic(), name != "anisotropic");
  }
}

TEST(SinglePrecision, AnyNumberOfPairs) {
  const NeuralBrdf network = RandomNetwork(Encoding::kMultiscale);
  const std::vector<DirectionPair> all = RandomPairs(300, /*seed=*/2);
  const std::vector<Rgb> expected = Values(*network.SinglePrecision(), all);
  for (std::size_t count : {0, 1, 127, 128, 129, 256, 300}) {
    // One value more, to stay as it is.
    std::vector<Rgb> values(count + 1, Rgb{-1.0, -1.0, -1.0});
    const auto fast = network.SinglePrecision();
    fast->EvaluateUnclipped({all.data(), count}, {values.data(), count});
    for (std::size_t n = 0; n < count; ++n) ASSERT_EQ(values[n], expected[n]);
    EXPECT_EQ(values[count][0], -1.0);
  }
}

TEST(SinglePrecision, ReciprocityIsExactToTheBit) {
  const std::vector<DirectionPair> pairs = PairsOfTheSphere(20000);
  std::vector<DirectionPair> swapped;
  for (const DirectionPair& pair : pairs) swapped.push_back(Swapped(pair));
  std::reverse(swapped.begin(), swapped.end());
  for (const auto& [name, encoding] : kEncodings) {
    if (!IsReciprocal(encoding)) continue;
    const auto network = RandomNetwork(encoding).SinglePrecision();
    ForEachInstructionSet([&](const char* set) {
      const std::vector<Rgb> there = Values(*network, pairs), back = Values(*network, swapped);
      for (std::size_t n = 0; n < pairs.size(); ++n) {
        ASSERT_EQ(there[n], back[pairs.size() - 1 - n]) << set;
      }
    });
  }
}

TEST(SinglePrecision, IsZeroBelowTheHorizon) {
  const std::vector<DirectionPair> pairs = PairsOfTheSphere(1000);
  std::vector<Rgb> values(pairs.size());
  RandomNetwork(Encoding::kMultiscale).SinglePrecision()->Evaluate(pairs, values);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (pairs[n].AboveHorizon()) continue;
    EXPECT_EQ(values[n], Rgb{});
  }
}

TEST(SinglePrecision, NothingNonFiniteComesOut) {
  std::vector<DirectionPair> pairs = PairsOfTheSphere(1000);
  const Vec3 up = {0.0, 0.0, 1.0};
  pairs.push_back({up, {0.0, 0.0, -1.0}});
  pairs.push_back({{std::nan(""), 0.0, 0.0}, up});
  pairs.push_back({{}, {}});
  for (double scale : {1.0, 1e3, 1e30, 1e150}) {
    for (const auto& [name, activation] : kActivations) {
      const auto network =
          RandomNetwork(Encoding::kMultiscale, activation, {21, 21}, scale).SinglePrecision();
      ForEachInstructionSet([&](const char* set) {
        for (const Rgb& value : Values(*network, pairs)) {
          for (double f : value) EXPECT_TRUE(f >= 0.0 && f <= Brdf::kLargestValue) << set;
        }
      });
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
