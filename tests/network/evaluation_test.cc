// Vectors of float against double precision, on each instruction set.
#include "network/evaluation.h"

#include <limits>

#include "brdf/direction_pairs.h"
#include "instruction_sets.h"
#include "kernels/kernels.h"

namespace pbnbrdf {
namespace {

using kernels::kBatch;

std::vector<DirectionPair> WholeBatches() {
  std::vector<DirectionPair> pairs = HardAndRandomPairs(5000, /*seed=*/6);
  pairs.resize(pairs.size() / kBatch * kBatch);
  return pairs;
}

// For each pair its kEncodedSize inputs.
std::vector<std::array<float, kEncodedSize>> EncodeAll(Encoding encoding,
                                                       const std::vector<DirectionPair>& pairs) {
  std::vector<std::array<float, kEncodedSize>> result(pairs.size());
  std::vector<float> batch(kEncodedSize * kBatch);
  for (std::size_t first = 0; first < pairs.size(); first += kBatch) {
    EncodeBatch(encoding, &pairs[first], batch.data());
    for (int n = 0; n < kBatch; ++n) {
      for (int i = 0; i < kEncodedSize; ++i) result[first + n][i] = batch[i * kBatch + n];
    }
  }
  return result;
}

TEST(Evaluation, InputsAreThoseOfDoublePrecision) {
  const std::vector<DirectionPair> pairs = WholeBatches();
  for (const auto& [name, encoding] : kEncodings) {
    ForEachInstructionSet([&, name = name, encoding = encoding](const char* set) {
      const auto inputs = EncodeAll(encoding, pairs);
      for (std::size_t n = 0; n < pairs.size(); ++n) {
        const Inputs<double> expected = Encode(encoding, pairs[n]);
        for (int i = 0; i < kEncodedSize; ++i) {
          // As evaluation.h promises.
          const double allowed = encoding == Encoding::kMerl && i == 0 ? 1e-4 : 2e-6;
          ASSERT_NEAR(inputs[n][i], expected[i], allowed)
              << set << ", " << name << ", pair " << n << ", input " << i;
        }
      }
    });
  }
}

TEST(Evaluation, InputsOfReciprocalEncodingsAreSoToTheBit) {
  const std::vector<DirectionPair> pairs = WholeBatches();
  std::vector<DirectionPair> swapped;
  for (const DirectionPair& pair : pairs) swapped.push_back(Swapped(pair));
  for (const auto& [name, encoding] : kEncodings) {
    ForEachInstructionSet([&, name = name, encoding = encoding](const char* set) {
      EXPECT_EQ(EncodeAll(encoding, pairs) == EncodeAll(encoding, swapped), IsReciprocal(encoding))
          << set << ", " << name;
    });
  }
}

TEST(Evaluation, ReflectancesAreThoseOfDoublePrecision) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> z(3 * kBatch);
  for (std::size_t i = 0; i < z.size(); ++i) z[i] = -1.0f + 0.1f * static_cast<float>(i);
  const float special[] = {kInfinity, -kInfinity, std::nanf(""), 0.0f, -0.0f, 1e-30f, 1e30f};
  std::copy(std::begin(special), std::end(special), z.begin());
  ForEachInstructionSet([&](const char* set) {
    std::vector<Rgb> f(kBatch);
    ReflectanceBatch(z.data(), f.data());
    for (int n = 0; n < kBatch; ++n) {
      for (int c = 0; c < 3; ++c) {
        const double expected = ClampedReflectance(static_cast<double>(z[c * kBatch + n]));
        EXPECT_GE(expected, 0.0);
        EXPECT_LE(expected, Brdf::kLargestValue);
        EXPECT_NEAR(f[n][c], expected, 1e-6 * expected) << set << ", z = " << z[c * kBatch + n];
      }
    }
  });
}

}  // namespace
}  // namespace pbnbrdf
