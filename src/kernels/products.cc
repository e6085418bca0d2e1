// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/products.h"

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "products.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

// Rows of the register block of AddProduct. With 3 vectors a row it fills all registers.
constexpr int kBlockRows = kManyRegisters ? 8 : 4;
constexpr int kRowProductRows = HWY_MAX_BYTES >= 64 ? 4 : 2;

template <typename T>
HWY_INLINE void PairProductsOf(const T* a, int na, const T* b, int nb, bool symmetric, T* out,
                               int out_stride) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int n = 0; n < kBatch; ++n, a += Padded(na), b += Padded(nb)) {
    T* to = out + static_cast<std::size_t>(n) * out_stride;
    for (int i = 0; i < na; ++i) {
      const int first = symmetric ? i : 0;
      const auto factor = hn::Set(d, a[i]);
      // A whole vector is written at the end of each run of pairs; the next run overwrites the
      // rest.
      for (int j = first; j < nb; j += lanes) {
        hn::StoreU(hn::Mul(factor, hn::LoadU(d, b + j)), d, to + (j - first));
      }
      to += nb - first;
    }
    for (int j = 0; j < kPad; j += lanes) hn::StoreU(hn::Zero(d), d, to + j);
  }
}

// Two vectors of samples at a time: all rows of a and b at these stay in the first-level cache.
template <typename T>
HWY_INLINE void SummedPairProductsOf(const T* a, int na, const T* b, int nb, int rows,
                                     bool symmetric, T* out) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int n = 0; n < kBatch; n += 2 * lanes) {
    T* to = out + n;
    for (int i = 0; i < na; ++i) {
      for (int j = symmetric ? i : 0; j < nb; ++j, to += kBatch) {
        auto sum0 = hn::Zero(d), sum1 = hn::Zero(d);
        for (int r = 0; r < rows; ++r) {
          const T* from_a = a + (r * na + i) * kBatch + n;
          const T* from_b = b + (r * nb + j) * kBatch + n;
          sum0 = hn::MulAdd(hn::LoadU(d, from_a), hn::LoadU(d, from_b), sum0);
          sum1 = hn::MulAdd(hn::LoadU(d, from_a + lanes), hn::LoadU(d, from_b + lanes), sum1);
        }
        hn::StoreU(sum0, d, to);
        hn::StoreU(sum1, d, to + lanes);
      }
    }
  }
}

// c += v, in double.
template <class D, class V>
HWY_INLINE void AddTo(D d, V v, double* c) {
  using T = hn::TFromD<D>;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<T, decltype(dd)> part;
  HWY_ALIGN T values[HWY_MAX_BYTES / sizeof(T)];
  hn::Store(v, d, values);
  for (std::size_t i = 0; i < hn::Lanes(d); i += hn::Lanes(dd)) {
    const auto values_i = hn::Load(part, values + i);
    if constexpr (sizeof(T) == sizeof(double)) {
      hn::StoreU(hn::Add(hn::LoadU(dd, c + i), values_i), dd, c + i);
    } else {
      hn::StoreU(hn::Add(hn::LoadU(dd, c + i), hn::PromoteTo(dd, values_i)), dd, c + i);
    }
  }
}

// kRows x kVectors vectors of c.
template <int kRows, int kVectors, typename T>
HWY_INLINE void ProductBlock(const T* x, const T* y, int y_stride, double* c, int c_stride) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kVectors * lanes; j += 64 / sizeof(double)) {
      hwy::Prefetch(c + i * c_stride + j);
    }
  }
  hn::Vec<decltype(d)> sum[kRows][kVectors];
  for (auto& row : sum) {
    for (auto& s : row) s = hn::Zero(d);
  }
  for (int n = 0; n < kBatch; ++n, y += y_stride) {
    hn::Vec<decltype(d)> from[kVectors];
    for (int v = 0; v < kVectors; ++v) from[v] = hn::LoadU(d, y + v * lanes);
    for (int i = 0; i < kRows; ++i) {
      const auto factor = hn::Set(d, x[i * kBatch + n]);
      for (int v = 0; v < kVectors; ++v) sum[i][v] = hn::MulAdd(factor, from[v], sum[i][v]);
    }
  }
  for (int i = 0; i < kRows; ++i) {
    for (int v = 0; v < kVectors; ++v) AddTo(d, sum[i][v], c + i * c_stride + v * lanes);
  }
}

// ProductBlock<rows, kVectors>, 1 <= rows <= kMaxRows.
template <int kMaxRows, int kVectors, typename T>
HWY_INLINE void ProductRows(int rows, const T* x, const T* y, int y_stride, double* c,
                            int c_stride) {
  if (rows == kMaxRows) {
    ProductBlock<kMaxRows, kVectors>(x, y, y_stride, c, c_stride);
  } else if constexpr (kMaxRows > 1) {
    ProductRows<kMaxRows - 1, kVectors>(rows, x, y, y_stride, c, c_stride);
  }
}

// kVectors vectors of columns: a panel of y that stays in the first-level cache while x streams by.
// The rows of x are in blocks of about equal size.
template <int kVectors, typename T>
HWY_NOINLINE void ProductPanel(const T* x, int p, const T* y, int y_stride, double* c,
                               int c_stride) {
  const int blocks = (p + kBlockRows - 1) / kBlockRows;
  for (int b = 0; b < blocks; ++b) {
    const int begin = b * p / blocks, end = (b + 1) * p / blocks;
    ProductRows<kBlockRows, kVectors>(end - begin, x + begin * kBatch, y, y_stride,
                                      c + begin * c_stride, c_stride);
  }
}

template <typename T>
HWY_INLINE void AddProductOf(const T* x, int p, const T* y, int q, int y_stride, double* c) {
  const int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<T>()));
  const int c_stride = Padded(q);
  for (int j = 0; j < q;) {
    const int vectors = (q - j + lanes - 1) / lanes;
    if (vectors >= 3 && vectors != 4) {
      ProductPanel<3>(x, p, y + j, y_stride, c + j, c_stride);
      j += 3 * lanes;
    } else if (vectors >= 2) {
      ProductPanel<2>(x, p, y + j, y_stride, c + j, c_stride);
      j += 2 * lanes;
    } else {
      ProductPanel<1>(x, p, y + j, y_stride, c + j, c_stride);
      j += lanes;
    }
  }
}

// to[k] += alpha times the sum of the numbers in the vector sum[k], k < kCount. Four sums of floats are taken
// together: one by one they would take longer than the dot products.
template <int kCount, typename T, class V>
HWY_INLINE void AddLaneSums(T alpha, const V* sum, T* to) {
  const hn::ScalableTag<T> d;
#if HWY_TARGET != HWY_SCALAR
  if constexpr (kCount == 4 && sizeof(T) == 4) {
    const hn::RepartitionToWide<decltype(d)> wide;
    const auto pairs = [&](V a, V b) {
      return hn::BitCast(wide, hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b)));
    };
    const auto low = pairs(sum[0], sum[1]), high = pairs(sum[2], sum[3]);
    const V fours = hn::Add(hn::BitCast(d, hn::InterleaveLower(wide, low, high)),
                            hn::BitCast(d, hn::InterleaveUpper(wide, low, high)));
    HWY_ALIGN T lanes[HWY_MAX_BYTES / sizeof(T)];
    hn::Store(fours, d, lanes);
    const hn::Full128<T> d4;
    auto total = hn::Load(d4, lanes);
    for (std::size_t i = 4; i < hn::Lanes(d); i += 4) {
      total = hn::Add(total, hn::Load(d4, lanes + i));
    }
    hn::StoreU(hn::MulAdd(hn::Set(d4, alpha), total, hn::LoadU(d4, to)), d4, to);
    return;
  }
#endif
  for (int k = 0; k < kCount; ++k) to[k] += alpha * hn::GetLane(hn::SumOfLanes(d, sum[k]));
}

// kX x kY entries of c, each a dot product along rows.
template <int kX, int kY, typename T>
HWY_INLINE void RowProductBlock(T alpha, const T* x, int x_stride, const T* y, int y_stride,
                                int size, T* c, int c_stride) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  hn::Vec<decltype(d)> sum[kX][kY];
  for (auto& row : sum) {
    for (auto& s : row) s = hn::Zero(d);
  }
  int k = 0;
  for (; k + lanes <= size; k += lanes) {
    hn::Vec<decltype(d)> from[kY];
    for (int j = 0; j < kY; ++j) from[j] = hn::LoadU(d, y + j * y_stride + k);
    for (int i = 0; i < kX; ++i) {
      const auto factor = hn::LoadU(d, x + i * x_stride + k);
      for (int j = 0; j < kY; ++j) sum[i][j] = hn::MulAdd(factor, from[j], sum[i][j]);
    }
  }
  for (int i = 0; i < kX; ++i) {
    AddLaneSums<kY>(alpha, sum[i], c + i * c_stride);
    for (int j = 0; j < kY && k < size; ++j) {
      T total = 0;
      for (int rest = k; rest < size; ++rest)
        total += x[i * x_stride + rest] * y[j * y_stride + rest];
      c[i * c_stride + j] += alpha * total;
    }
  }
}

template <int kX, typename T>
HWY_INLINE void RowProductBlocks(T alpha, const T* x, int x_stride, const T* y, int rows_y,
                                 int y_stride, int size, T* c, int c_stride) {
  int j = 0;
  for (; j + 4 <= rows_y; j += 4) {
    RowProductBlock<kX, 4>(alpha, x, x_stride, y + j * y_stride, y_stride, size, c + j, c_stride);
  }
  for (; j < rows_y; ++j) {
    RowProductBlock<kX, 1>(alpha, x, x_stride, y + j * y_stride, y_stride, size, c + j, c_stride);
  }
}

template <typename T>
HWY_INLINE void AddAllRowProducts(T alpha, const T* x, int rows_x, int x_stride, const T* y,
                                  int rows_y, int y_stride, int size, T* c, int c_stride) {
  int i = 0;
  for (; i + kRowProductRows <= rows_x; i += kRowProductRows) {
    RowProductBlocks<kRowProductRows>(alpha, x + i * x_stride, x_stride, y, rows_y, y_stride, size,
                                      c + i * c_stride, c_stride);
  }
  for (; i < rows_x; ++i) {
    RowProductBlocks<1>(alpha, x + i * x_stride, x_stride, y, rows_y, y_stride, size,
                        c + i * c_stride, c_stride);
  }
}

// The exported names: one for each precision, as HWY_EXPORT wants plain functions.
#define PBNBRDF_KERNELS(T, Suffix)                                                          \
  void PairProducts##Suffix(const T* a, int na, const T* b, int nb, bool symmetric, T* out, \
                            int out_stride) {                                               \
    PairProductsOf(a, na, b, nb, symmetric, out, out_stride);                               \
  }                                                                                         \
  void SummedPairProducts##Suffix(const T* a, int na, const T* b, int nb, int rows,         \
                                  bool symmetric, T* out) {                                 \
    SummedPairProductsOf(a, na, b, nb, rows, symmetric, out);                               \
  }                                                                                         \
  void AddProduct##Suffix(const T* x, int p, const T* y, int q, int y_stride, double* c) {  \
    AddProductOf(x, p, y, q, y_stride, c);                                                  \
  }                                                                                         \
  void AddRowProducts##Suffix(T alpha, const T* x, int rows_x, int x_stride, const T* y,    \
                              int rows_y, int y_stride, int size, T* c, int c_stride) {     \
    AddAllRowProducts(alpha, x, rows_x, x_stride, y, rows_y, y_stride, size, c, c_stride);  \
  }

PBNBRDF_KERNELS(float, F)
PBNBRDF_KERNELS(double, D)
#undef PBNBRDF_KERNELS

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

#define PBNBRDF_DISPATCH(T, Suffix)                                                          \
  HWY_EXPORT(PairProducts##Suffix);                                                          \
  HWY_EXPORT(SummedPairProducts##Suffix);                                                    \
  HWY_EXPORT(AddProduct##Suffix);                                                            \
  HWY_EXPORT(AddRowProducts##Suffix);                                                        \
  template <>                                                                                \
  void PairProducts(const T* a, int na, const T* b, int nb, bool symmetric, T* out,          \
                    int out_stride) {                                                        \
    HWY_DYNAMIC_DISPATCH(PairProducts##Suffix)(a, na, b, nb, symmetric, out, out_stride);    \
  }                                                                                          \
  template <>                                                                                \
  void SummedPairProducts(const T* a, int na, const T* b, int nb, int rows, bool symmetric,  \
                          T* out) {                                                          \
    HWY_DYNAMIC_DISPATCH(SummedPairProducts##Suffix)(a, na, b, nb, rows, symmetric, out);    \
  }                                                                                          \
  template <>                                                                                \
  void AddProduct(const T* x, int p, const T* y, int q, int y_stride, double* c) {           \
    HWY_DYNAMIC_DISPATCH(AddProduct##Suffix)(x, p, y, q, y_stride, c);                       \
  }                                                                                          \
  template <>                                                                                \
  void AddRowProducts(T alpha, const T* x, int rows_x, int x_stride, const T* y, int rows_y, \
                      int y_stride, int size, T* c, int c_stride) {                          \
    HWY_DYNAMIC_DISPATCH(AddRowProducts##Suffix)                                             \
    (alpha, x, rows_x, x_stride, y, rows_y, y_stride, size, c, c_stride);                    \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
