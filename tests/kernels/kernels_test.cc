// Each kernel against the plain loops that define it, at sizes around those of a register block and
// on each instruction set.
#include "pbnbrdf/kernels/kernels.h"

#include "instruction_sets.h"
#include "test_util.h"

namespace pbnbrdf::kernels {
namespace {

template <typename T>
std::vector<T> Random(std::size_t count, unsigned seed) {
  const std::vector<double> numbers = RandomNumbers(count, -1.0, 1.0, seed);
  return {numbers.begin(), numbers.end()};
}

template <typename T>
class Kernels : public testing::Test {
 protected:
  // A sum of n products of numbers up to 1 is off by at most about n^2 eps; this is for n <= 128.
  static constexpr double kTolerance = 256.0 * std::numeric_limits<T>::epsilon();
};

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Kernels, Precisions);

TYPED_TEST(Kernels, DenseIsWxPlusB) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [out, in] : {std::pair(1, 1), {3, 22}, {4, 6}, {21, 6}, {21, 21}, {65, 33}}) {
      const auto layer = Random<T>(out * (in + 1), 1), x = Random<T>(in * kBatch, 2);
      std::vector<T> y(out * kBatch);
      Dense(layer.data(), out, in, x.data(), y.data());
      for (int o = 0; o < out; ++o) {
        for (int n = 0; n < kBatch; ++n) {
          double sum = layer[o * (in + 1) + in];
          for (int i = 0; i < in; ++i) sum += double(layer[o * (in + 1) + i]) * x[i * kBatch + n];
          ASSERT_NEAR(y[o * kBatch + n], sum, this->kTolerance) << out << " x " << in;
        }
      }
    }
  });
}

TYPED_TEST(Kernels, DenseTransposedIsWTransposedY) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [out, in] : {std::pair(1, 1), {3, 22}, {21, 6}, {33, 65}}) {
      const auto layer = Random<T>(out * (in + 1), 3), y = Random<T>(out * kBatch, 4);
      std::vector<T> x(in * kBatch);
      DenseTransposed(layer.data(), out, in, y.data(), x.data());
      for (int i = 0; i < in; ++i) {
        for (int n = 0; n < kBatch; ++n) {
          double sum = 0.0;
          for (int o = 0; o < out; ++o) sum += double(layer[o * (in + 1) + i]) * y[o * kBatch + n];
          ASSERT_NEAR(x[i * kBatch + n], sum, this->kTolerance) << out << " x " << in;
        }
      }
    }
  });
}

// From denormal to infinite, and densely where tanh bends.
template <typename T>
std::vector<T> TanhArguments() {
  std::vector<T> x(800 * kBatch);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = i % 2 ? static_cast<T>(10.0 * static_cast<double>(i) / static_cast<double>(x.size()))
                 : static_cast<T>(std::ldexp(1.3, int(i % 280) - 140));
  }
  x[0] = 0;
  x[2] = std::numeric_limits<T>::infinity();
  return x;
}

TYPED_TEST(Kernels, ReluAndItsSlopes) {
  using T = TypeParam;
  std::vector<T> x = Random<T>(2 * kBatch, 5), delta = Random<T>(2 * kBatch, 6);
  x[3] = 0;
  x[5] = std::numeric_limits<T>::quiet_NaN();
  x[6] = -x[5];
  std::vector<T> y = x, gradient = delta;
  Relu(y.data(), y.size());
  ReluSlopes(y.data(), y.size(), gradient.data());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i])) {
      EXPECT_TRUE(std::isnan(y[i]));  // an overflow must stay visible
    } else {
      EXPECT_EQ(y[i], x[i] > 0 ? x[i] : 0);
      EXPECT_EQ(gradient[i], x[i] > 0 ? delta[i] : 0);
    }
  }
}

TYPED_TEST(Kernels, AbsoluteLossGradientStandsUpToLargeAndSmallOutputs) {
  // In the limits 1 + f^ cos_i ~ f^ cos_i and f^ = -1. The formula itself: minibatch_gradient_test.
  using T = TypeParam;
  std::vector<T> z(3 * kBatch), cos_i(kBatch, T(1)), f(3 * kBatch, T(0.5)), gradient(3 * kBatch);
  std::fill_n(z.begin(), kBatch, T(40));
  std::fill_n(z.begin() + kBatch, kBatch, T(-40));
  std::fill_n(z.begin() + 2 * kBatch, kBatch, std::log1p(T(0.5)));
  cos_i[1] = 0;  // no light
  AbsoluteLossGradient(z.data(), cos_i.data(), f.data(), T(2), T(0), gradient.data());
  for (int n = 0; n < kBatch; ++n) {
    EXPECT_NEAR(gradient[n], n == 1 ? 0 : 2, 1e-6);
    EXPECT_NEAR(gradient[kBatch + n], n == 1 ? 0 : -2, 1e-6);
    EXPECT_LE(std::abs(gradient[2 * kBatch + n]), 2);  // a kink
  }
}

TYPED_TEST(Kernels, ReflectanceSumsAreClamped) {
  using T = TypeParam;
  const auto z = Random<T>(3 * kBatch, 7), weights = Random<T>(kBatch, 8);
  T sums[3] = {1, 2, 3};
  AddReflectanceSums(z.data(), weights.data(), sums);
  for (int c = 0; c < 3; ++c) {
    double sum = c + 1;
    for (int n = 0; n < kBatch; ++n) {
      sum += weights[n] * std::expm1(std::max(0.0, double(z[c * kBatch + n])));
    }
    EXPECT_NEAR(sums[c], sum, this->kTolerance);
  }
}

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

TYPED_TEST(Kernels, TanhIsAsAccurateAsStated) {
  using T = TypeParam;
  const std::vector<T> x = TanhArguments<T>();
  ForEachInstructionSet([&](const char* set) {
    std::vector<T> y = x;
    Tanh(y.data(), y.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      worst = std::max(worst, std::abs(y[i] - std::tanh(double(x[i]))));
    }
    EXPECT_LT(worst, sizeof(T) == 4 ? 4e-7 : 1e-14) << set;
  });
}

TYPED_TEST(Kernels, TanhIsOddAndBoundedAndKeepsNaN) {
  using T = TypeParam;
  const std::vector<T> x = TanhArguments<T>();
  ForEachInstructionSet([&](const char* set) {
    std::vector<T> y = x, mirrored;
    for (T value : x) mirrored.push_back(-value);
    y[4] = std::numeric_limits<T>::quiet_NaN();
    Tanh(y.data(), y.size());
    Tanh(mirrored.data(), mirrored.size());
    EXPECT_TRUE(std::isnan(y[4])) << set;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (i == 4) continue;
      ASSERT_EQ(mirrored[i], -y[i]) << set << ", x = " << x[i];
      ASSERT_LE(std::abs(y[i]), T(1)) << set << ", x = " << x[i];
    }
  });
}

TYPED_TEST(Kernels, DenseTanhIsDenseThenTanh) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [out, in] : {std::pair(1, 1), {3, 22}, {21, 6}, {21, 21}, {65, 33}}) {
      const auto layer = Random<T>(out * (in + 1), 1), x = Random<T>(in * kBatch, 2);
      std::vector<T> y(out * kBatch), expected(out * kBatch);
      DenseTanh(layer.data(), out, in, x.data(), y.data());
      Dense(layer.data(), out, in, x.data(), expected.data());
      Tanh(expected.data(), expected.size());
      EXPECT_EQ(y, expected) << out << " x " << in;
    }
  });
}

TYPED_TEST(Kernels, PairProductsAreInOrderWithZerosBehind) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [na, nb, symmetric] :
         {std::tuple(21, 21, true), {7, 22, false}, {1, 1, true}, {3, 3, true}, {33, 17, false}}) {
      const auto a = Random<T>(kBatch * Padded(na) + kPad, 5);
      const auto b = symmetric ? a : Random<T>(kBatch * Padded(nb) + kPad, 6);
      const int pairs = symmetric ? na * (na + 1) / 2 : na * nb;
      const int stride = pairs + kPad + 3;
      std::vector<T> out(kBatch * stride, T(7));
      PairProducts(a.data(), na, b.data(), nb, symmetric, out.data(), stride);
      for (int n = 0; n < kBatch; ++n) {
        const T* at = out.data() + n * stride;
        for (int i = 0; i < na; ++i) {
          for (int j = symmetric ? i : 0; j < nb; ++j, ++at) {
            ASSERT_EQ(*at, a[n * Padded(na) + i] * b[n * Padded(nb) + j]) << na << " x " << nb;
          }
        }
        for (int k = 0; k < kPad; ++k) ASSERT_EQ(at[k], T(0));
        for (int k = kPad; k < kPad + 3; ++k) ASSERT_EQ(at[k], T(7));
      }
    }
  });
}

TYPED_TEST(Kernels, SummedPairProductsSumOverRows) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [na, nb, rows, symmetric] : {std::tuple(21, 21, 3, true),
                                           {21, 3, 4, false},
                                           {7, 22, 1, false},
                                           {1, 1, 1, true},
                                           {33, 17, 2, false}}) {
      const auto a = Random<T>(rows * na * kBatch, 5);
      const auto b = symmetric ? a : Random<T>(rows * nb * kBatch, 6);
      const int pairs = symmetric ? na * (na + 1) / 2 : na * nb;
      std::vector<T> out((pairs + 1) * kBatch, T(7));
      SummedPairProducts(a.data(), na, b.data(), nb, rows, symmetric, out.data());
      const T* at = out.data();
      for (int i = 0; i < na; ++i) {
        for (int j = symmetric ? i : 0; j < nb; ++j) {
          for (int n = 0; n < kBatch; ++n, ++at) {
            double sum = 0.0;
            for (int r = 0; r < rows; ++r) {
              sum += double(a[(r * na + i) * kBatch + n]) * b[(r * nb + j) * kBatch + n];
            }
            ASSERT_NEAR(*at, sum, this->kTolerance) << na << " x " << nb;
          }
        }
      }
      for (int n = 0; n < kBatch; ++n) ASSERT_EQ(at[n], T(7));
    }
  });
}

TYPED_TEST(Kernels, AddProductAdds) {
  using T = TypeParam;
  for (auto [p, q] : {std::pair(1, 1), {8, 48}, {9, 49}, {231, 253}, {21, 7}, {63, 154}}) {
    const int y_stride = Padded(q);
    const auto x = Random<T>(p * kBatch, 7), y = Random<T>(kBatch * y_stride, 8);
    const std::vector<double> before((p + 1) * Padded(q), 0.5);
    ForEachInstructionSet([&, p = p, q = q](const char* set) {
      std::vector<double> c = before;
      AddProduct(x.data(), p, y.data(), q, y_stride, c.data());
      for (int i = 0; i < p; ++i) {
        for (int j = 0; j < q; ++j) {
          double sum = 0.5;
          for (int n = 0; n < kBatch; ++n) sum += double(x[i * kBatch + n]) * y[n * y_stride + j];
          ASSERT_NEAR(c[i * Padded(q) + j], sum, this->kTolerance) << set << p << " x " << q;
        }
      }
      for (int j = 0; j < Padded(q); ++j) ASSERT_EQ(c[p * Padded(q) + j], 0.5);
    });
  }
}

TYPED_TEST(Kernels, AddRowProductsAdds) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [p, q, size] :
         {std::tuple(1, 1, 1), {4, 4, 128}, {5, 7, 31}, {21, 22, 128}, {3, 9, 0}}) {
      const int stride = size + 3;
      const auto x = Random<T>(p * stride, 9), y = Random<T>(q * stride, 10);
      std::vector<T> c(p * (q + 1), T(0.5));
      AddRowProducts(T(-2), x.data(), p, stride, y.data(), q, stride, size, c.data(), q + 1);
      for (int i = 0; i < p; ++i) {
        for (int j = 0; j < q; ++j) {
          double sum = 0.5;
          for (int k = 0; k < size; ++k) sum -= 2.0 * x[i * stride + k] * y[j * stride + k];
          ASSERT_NEAR(c[i * (q + 1) + j], sum, 2.0 * this->kTolerance) << p << " x " << q;
        }
        ASSERT_EQ(c[i * (q + 1) + q], T(0.5));
      }
    }
  });
}

TYPED_TEST(Kernels, LogResidualsHaveTheirSlopes) {
  using T = TypeParam;
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

TYPED_TEST(Kernels, LogResidualsPassOnWhatIsNotFinite) {
  using T = TypeParam;
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

TYPED_TEST(Kernels, ExpIsAccurate) {
  using T = TypeParam;
  std::vector<T> x = Random<T>(kBatch, 11);
  for (T& value : x) value *= 20;
  std::vector<T> y = x;
  Exp(y.data(), y.size());
  for (int n = 0; n < kBatch; ++n) {
    const double exact = std::exp(double(x[n]));
    EXPECT_NEAR(y[n], exact, 8 * std::numeric_limits<T>::epsilon() * exact);
  }
}

}  // namespace
}  // namespace pbnbrdf::kernels
