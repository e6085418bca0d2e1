// Each kernel against the formula that defines it, and in its limits.
#include "kernels/losses.h"

#include "instruction_sets.h"
#include "kernels_test_util.h"
#include "test_util.h"

namespace pbnbrdf::kernels {
namespace {

TEST(Losses, LogResidualsHaveTheirSlopes) {
  using T = double;
  std::vector<T> z = Random<T>(3 * kBatch, 12);
  for (std::size_t k = 0; k < z.size(); ++k)
    z[k] *= k % 3 == 0 ? T(1e-6) : k % 3 == 1 ? T(1) : T(20);
  const auto targets = RandomNumbers(3 * kBatch, 0.0, 3.0, 13);
  const auto cos_i = RandomNumbers(kBatch, 0.0, 1.0, 14);
  ForEachInstructionSet([&](const char* set) {
    std::vector<double> residuals(3 * kBatch), slopes(3 * kBatch);
    LogResiduals(z.data(), targets.data(), cos_i.data(), residuals.data(), slopes.data());
    for (int k = 0; k < 3 * kBatch; ++k) {
      const double x = z[k], cos = cos_i[k % kBatch], log = std::log1p(std::expm1(x) * cos);
      EXPECT_NEAR(residuals[k], targets[k] - log, 2e-15 * (targets[k] + std::abs(log))) << set;
      const double slope = -std::exp(x) * cos / (1.0 + std::expm1(x) * cos);
      // expm1(z) + 1 and 1 + u cancel where z is very negative and cos_i close to 1.
      EXPECT_NEAR(slopes[k], slope, 4e-15 * (cos / (1.0 + std::expm1(x) * cos) - slope)) << set;
    }
  });
}

TEST(Losses, LogResidualsAreExactAtNormalIncidence) {
  // Where expm1 rounds to -1 and where it overflows, too.
  using T = double;
  const std::vector<double> targets(3 * kBatch, 1.0), cos_i(kBatch, 1.0);
  for (T z : {T(-1e4), T(-40), T(-0.5), T(0), T(3), T(1e4)}) {
    const std::vector<T> all(3 * kBatch, z);
    ForEachInstructionSet([&](const char* set) {
      std::vector<double> residuals(3 * kBatch), slopes(3 * kBatch);
      LogResiduals(all.data(), targets.data(), cos_i.data(), residuals.data(), slopes.data());
      for (double r : residuals) EXPECT_EQ(r, 1.0 - static_cast<double>(z)) << set;
      for (double slope : slopes) EXPECT_EQ(slope, -1.0) << set;
    });
  }
}

TEST(Losses, LogResidualsPassOnWhatIsNotFinite) {
  using T = double;
  constexpr T kInfinity = std::numeric_limits<T>::infinity();
  const std::vector<double> targets(3 * kBatch, 1.0), cos_i(kBatch, 0.5);
  for (T bad : {T(1e4), kInfinity, -kInfinity, std::numeric_limits<T>::quiet_NaN()}) {
    const std::vector<T> z(3 * kBatch, bad);
    ForEachInstructionSet([&](const char* set) {
      std::vector<double> residuals(3 * kBatch), slopes(3 * kBatch);
      LogResiduals(z.data(), targets.data(), cos_i.data(), residuals.data(), slopes.data());
      for (double r : residuals) EXPECT_FALSE(std::isfinite(r)) << set << ", z = " << bad;
    });
  }
}

TEST(Losses, AbsoluteLogGradientStandsUpToLargeAndSmallOutputs) {
  // In the limits 1 + f^ cos_i ~ f^ cos_i and f^ = -1. The formula itself: minibatch_gradient_test.
  using T = float;
  std::vector<T> z(3 * kBatch), cos_i(kBatch, T(1)), f(3 * kBatch, T(0.5)), gradient(3 * kBatch);
  std::fill_n(z.begin(), kBatch, T(40));
  std::fill_n(z.begin() + kBatch, kBatch, T(-40));
  std::fill_n(z.begin() + 2 * kBatch, kBatch, std::log1p(T(0.5)));
  cos_i[1] = 0;  // no light
  AddAbsoluteLogGradient(z.data(), cos_i.data(), f.data(), T(2), gradient.data());
  for (int n = 0; n < kBatch; ++n) {
    EXPECT_NEAR(gradient[n], n == 1 ? 0 : 2, 1e-6);
    EXPECT_NEAR(gradient[kBatch + n], n == 1 ? 0 : -2, 1e-6);
    EXPECT_LE(std::abs(gradient[2 * kBatch + n]), 2);  // a kink
  }
}

TEST(Losses, AbsoluteLossGradientIsThatOfTheLimitWhereReflectanceOverflows) {
  using T = float;
  const std::vector<T> cos_i(kBatch, T(0.5)), f(3 * kBatch, T(0.5));
  const auto gradient_at = [&](T output) {
    const std::vector<T> z(3 * kBatch, output);
    std::vector<T> gradient(3 * kBatch);
    AddAbsoluteLogGradient(z.data(), cos_i.data(), f.data(), T(2), gradient.data());
    AddAbsoluteChromaticityGradient(z.data(), cos_i.data(), f.data(), T(1), gradient.data());
    return gradient;
  };
  const std::vector<T> limit = gradient_at(T(40)), gradient = gradient_at(T(500));
  EXPECT_EQ(gradient, limit);
  for (T g : gradient) EXPECT_NEAR(g, 2.0 + 2.0 / 3.0, 1e-5);
}

TEST(Losses, ReflectanceSumsAreClamped) {
  using T = float;
  constexpr double kTolerance = 1e-4;
  const auto z = Random<T>(3 * kBatch, 7), weights = Random<T>(kBatch, 8);
  T sums[3] = {1, 2, 3};
  AddReflectanceSums(z.data(), weights.data(), sums);
  for (int c = 0; c < 3; ++c) {
    double sum = c + 1;
    for (int n = 0; n < kBatch; ++n) {
      sum += weights[n] * std::expm1(std::max(0.0, double(z[c * kBatch + n])));
    }
    EXPECT_NEAR(sums[c], sum, kTolerance);
  }
}

TEST(Losses, AbsoluteGradientsAreAdded) {
  const auto z = Random<float>(3 * kBatch, 7), f = Random<float>(3 * kBatch, 8);
  const std::vector<float> cos_i(kBatch, 0.5f);
  std::vector<float> once(3 * kBatch), twice(3 * kBatch);
  AddAbsoluteLogGradient(z.data(), cos_i.data(), f.data(), 2.0f, once.data());
  AddAbsoluteLogGradient(z.data(), cos_i.data(), f.data(), 1.0f, twice.data());
  AddAbsoluteLogGradient(z.data(), cos_i.data(), f.data(), 1.0f, twice.data());
  for (int k = 0; k < 3 * kBatch; ++k) EXPECT_NEAR(once[k], twice[k], 1e-6);
}

TEST(AdamStep, IsThatOfThePaper) {
  constexpr std::size_t kCount = 3 * kPad;
  constexpr double kTolerance = 256.0 * std::numeric_limits<float>::epsilon();
  const auto gradient = Random<float>(kCount, 9);
  auto mean = Random<float>(kCount, 10), square = Random<float>(kCount, 11);
  auto x = Random<float>(kCount, 12);
  for (float& s : square) s = std::abs(s);
  const auto mean0 = mean, square0 = square, x0 = x;
  AdamStep(kCount, gradient.data(), 0.1f, 0.9f, 0.99f, 1e-8f, mean.data(), square.data(), x.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    const double m = 0.9 * mean0[i] + 0.1 * gradient[i];
    const double v = 0.99 * square0[i] + 0.01 * gradient[i] * gradient[i];
    EXPECT_NEAR(mean[i], m, kTolerance);
    EXPECT_NEAR(square[i], v, kTolerance);
    EXPECT_NEAR(x[i], x0[i] - 0.1 * m / (std::sqrt(v) + 1e-8), kTolerance);
  }
}

}  // namespace
}  // namespace pbnbrdf::kernels
