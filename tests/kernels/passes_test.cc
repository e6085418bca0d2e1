// Each kernel against the plain loops that define it, at sizes around those of a register block and
// on each instruction set.
#include "kernels/passes.h"

#include "instruction_sets.h"
#include "kernels_test_util.h"
#include "test_util.h"

namespace pbnbrdf::kernels {
namespace {

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

// In place, by a layer of one unit that passes its only input on. count: a multiple of kBatch.
template <typename T, typename Layer>
void Activate(Layer dense, T* x, std::size_t count) {
  const T layer[] = {1, 0};
  std::vector<T> y(kBatch);
  for (std::size_t first = 0; first < count; first += kBatch) {
    dense(layer, 1, 1, x + first, y.data());
    std::copy(y.begin(), y.end(), x + first);
  }
}

template <typename T>
void Tanh(T* x, std::size_t count) {
  Activate(DenseTanh<T>, x, count);
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

TYPED_TEST(Kernels, ActivatedLayersAreDenseThenActivated) {
  using T = TypeParam;
  ForEachInstructionSet([&](const char* set) {
    SCOPED_TRACE(set);
    for (auto [out, in] : {std::pair(1, 1), {3, 22}, {21, 6}, {21, 21}, {65, 33}}) {
      const auto layer = Random<T>(out * (in + 1), 1), x = Random<T>(in * kBatch, 2);
      std::vector<T> y(out * kBatch), expected(out * kBatch);
      DenseTanh(layer.data(), out, in, x.data(), y.data());
      Dense(layer.data(), out, in, x.data(), expected.data());
      std::vector<T> relu = expected;
      Tanh(expected.data(), expected.size());
      EXPECT_EQ(y, expected) << out << " x " << in;
      DenseRelu(layer.data(), out, in, x.data(), y.data());
      for (T& value : relu) value = std::max(value, T(0));
      EXPECT_EQ(y, relu) << out << " x " << in;
    }
  });
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

TYPED_TEST(Kernels, ReluAndItsSlopes) {
  using T = TypeParam;
  std::vector<T> x = Random<T>(2 * kBatch, 5), delta = Random<T>(2 * kBatch, 6);
  x[3] = 0;
  x[5] = std::numeric_limits<T>::quiet_NaN();
  x[6] = -x[5];
  std::vector<T> y = x, gradient = delta;
  Activate(DenseRelu<T>, y.data(), y.size());
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

}  // namespace
}  // namespace pbnbrdf::kernels
