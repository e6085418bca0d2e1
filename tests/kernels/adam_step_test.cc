// The kernel against the formulas that define it.
#include "kernels/adam_step.h"

#include "kernels_test_util.h"
#include "test_util.h"

namespace pbnbrdf::kernels {
namespace {

TYPED_TEST_SUITE(Kernels, Precisions);

TYPED_TEST(Kernels, AdamStepIsThatOfThePaper) {
  using T = TypeParam;
  constexpr std::size_t kCount = 3 * kPad;
  const auto gradient = Random<T>(kCount, 9);
  auto mean = Random<T>(kCount, 10), square = Random<T>(kCount, 11), x = Random<T>(kCount, 12);
  for (T& s : square) s = std::abs(s);
  const auto mean0 = mean, square0 = square, x0 = x;
  AdamStep(kCount, gradient.data(), T(0.1), T(0.9), T(0.99), T(1e-8), mean.data(), square.data(),
           x.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    const double m = 0.9 * mean0[i] + 0.1 * gradient[i];
    const double v = 0.99 * square0[i] + 0.01 * gradient[i] * gradient[i];
    EXPECT_NEAR(mean[i], m, this->kTolerance);
    EXPECT_NEAR(square[i], v, this->kTolerance);
    EXPECT_NEAR(x[i], x0[i] - 0.1 * m / (std::sqrt(v) + 1e-8), this->kTolerance);
  }
}

}  // namespace
}  // namespace pbnbrdf::kernels
