// Each kernel against the plain loops that define it, at sizes around those of a register block and
// on each instruction set.
#include "kernels/products.h"

#include "instruction_sets.h"
#include "kernels_test_util.h"
#include "test_util.h"

namespace pbnbrdf::kernels {
namespace {

TYPED_TEST_SUITE(Kernels, Precisions);

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

}  // namespace
}  // namespace pbnbrdf::kernels
