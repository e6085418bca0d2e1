// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "pbnbrdf/kernels/kernels.h"

// Vectors are kept in arrays, which those of unknown length can't be; the others are dispensable.
#define HWY_DISABLED_TARGETS                                                                   \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Rows of the register block of AddTransposedProduct: 3 vectors wide, it fills the register file.
constexpr int kBlockRows = HWY_MAX_BYTES >= 64 ? 8 : 4;
constexpr int kBlockVectors = 3;
constexpr int kDenseRows = HWY_MAX_BYTES >= 64 ? 6 : 4;
constexpr int kRowProductRows = HWY_MAX_BYTES >= 64 ? 4 : 2;
static_assert(kPad % kBlockRows == 0);

// kRows outputs at two vectors of samples; W is read as w[o * stride_o + i * stride_i].
template <int kRows, bool kBias, typename T>
HWY_INLINE void DenseBlock(const T* w, int stride_o, int stride_i, int in, const T* x, T* y) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int n = 0; n < kBatch; n += 2 * lanes) {
    hn::Vec<decltype(d)> sum[kRows][2];
    for (int o = 0; o < kRows; ++o) {
      sum[o][0] = sum[o][1] = kBias ? hn::Set(d, w[o * stride_o + in * stride_i]) : hn::Zero(d);
    }
    for (int i = 0; i < in; ++i) {
      const auto x0 = hn::LoadU(d, x + i * kBatch + n);
      const auto x1 = hn::LoadU(d, x + i * kBatch + n + lanes);
      for (int o = 0; o < kRows; ++o) {
        const auto weight = hn::Set(d, w[o * stride_o + i * stride_i]);
        sum[o][0] = hn::MulAdd(weight, x0, sum[o][0]);
        sum[o][1] = hn::MulAdd(weight, x1, sum[o][1]);
      }
    }
    for (int o = 0; o < kRows; ++o) {
      hn::StoreU(sum[o][0], d, y + o * kBatch + n);
      hn::StoreU(sum[o][1], d, y + o * kBatch + n + lanes);
    }
  }
}

template <bool kBias, typename T>
HWY_INLINE void DenseBlocks(const T* w, int stride_o, int stride_i, int out, int in, const T* x,
                            T* y) {
  int o = 0;
  for (; o + kDenseRows <= out; o += kDenseRows) {
    DenseBlock<kDenseRows, kBias>(w + o * stride_o, stride_o, stride_i, in, x, y + o * kBatch);
  }
  for (; o + 3 <= out; o += 3) {
    DenseBlock<3, kBias>(w + o * stride_o, stride_o, stride_i, in, x, y + o * kBatch);
  }
  for (; o < out; ++o) {
    DenseBlock<1, kBias>(w + o * stride_o, stride_o, stride_i, in, x, y + o * kBatch);
  }
}

template <typename T>
HWY_INLINE void TanhAll(T* x, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Tanh(d, hn::LoadU(d, x + i)), d, x + i);
  }
}

template <typename T>
HWY_INLINE void ExpAll(T* x, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Exp(d, hn::LoadU(d, x + i)), d, x + i);
  }
}

template <typename T>
HWY_INLINE void ReluAll(T* x, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Max(hn::Zero(d), hn::LoadU(d, x + i)), d, x + i);  // keeps a NaN
  }
}

template <typename T>
HWY_INLINE void ReluSlopesAll(const T* y, std::size_t count, T* delta) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto on = hn::Gt(hn::LoadU(d, y + i), hn::Zero(d));
    hn::StoreU(hn::IfThenElseZero(on, hn::LoadU(d, delta + i)), d, delta + i);
  }
}

// 1, 0 or -1.
template <class D, class V>
HWY_INLINE V Sign(D d, V x) {
  const V one = hn::Set(d, 1);
  const V magnitude = hn::IfThenZeroElse(hn::Eq(x, hn::Zero(d)), one);
  return hn::CopySign(magnitude, x);
}

template <typename T>
HWY_INLINE void AbsoluteLossGradientOf(const T* z, const T* cos_i, const T* f, T log_weight,
                                       T chromaticity_weight, T* gradient) {
  const hn::ScalableTag<T> d;
  const auto one = hn::Set(d, 1), least = hn::Set(d, T(1e-30));
  for (int n = 0; n < kBatch; n += static_cast<int>(hn::Lanes(d))) {
    const auto cos = hn::LoadU(d, cos_i + n), cos2 = hn::Mul(cos, cos);
    hn::Vec<decltype(d)> grown[3], fit[3];
    auto norm = hn::Zero(d), norm_fit = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
      grown[c] = hn::Exp(d, hn::LoadU(d, z + c * kBatch + n));
      fit[c] = hn::Sub(grown[c], one);
      const auto from = hn::LoadU(d, f + c * kBatch + n);
      norm = hn::MulAdd(from, from, norm);
      norm_fit = hn::MulAdd(fit[c], fit[c], norm_fit);
    }
    // |log1p(a) - log1p(b)| falls and rises with a as |a - b| does: no logarithm is needed.
    const auto side = Sign(d, hn::Sub(norm_fit, norm));
    const auto chroma = hn::Div(hn::Mul(hn::Set(d, 2 * chromaticity_weight), hn::Mul(side, cos2)),
                                hn::MulAdd(cos2, norm_fit, one));
    for (int c = 0; c < 3; ++c) {
      const auto from = hn::LoadU(d, f + c * kBatch + n);
      const auto up = hn::Mul(hn::Set(d, log_weight), Sign(d, hn::Sub(fit[c], from)));
      // 1 + f^ cos_i = (1 - cos_i) + cos_i exp(z), without the cancellation.
      const auto lit = hn::Max(hn::MulAdd(cos, grown[c], hn::Sub(one, cos)), least);
      const auto log = hn::Div(hn::Mul(up, cos), lit);
      hn::StoreU(hn::Mul(grown[c], hn::MulAdd(chroma, fit[c], log)), d, gradient + c * kBatch + n);
    }
  }
}

template <typename T>
HWY_INLINE void AddReflectanceSumsOf(const T* z, const T* weights, T* sums) {
  const hn::ScalableTag<T> d;
  for (int c = 0; c < 3; ++c) {
    auto sum = hn::Zero(d);
    for (int n = 0; n < kBatch; n += static_cast<int>(hn::Lanes(d))) {
      const auto grown = hn::Exp(d, hn::Max(hn::Zero(d), hn::LoadU(d, z + c * kBatch + n)));
      sum = hn::MulAdd(hn::LoadU(d, weights + n), hn::Sub(grown, hn::Set(d, 1)), sum);
    }
    sums[c] += hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

template <typename T>
HWY_INLINE void AdamStepOf(std::size_t count, const T* gradient, T rate, T beta1, T beta2,
                           T epsilon, T* mean, T* square, T* x) {
  const hn::ScalableTag<T> d;
  const auto b1 = hn::Set(d, beta1), b2 = hn::Set(d, beta2);
  // Those of a dead unit would decay to subnormal numbers, which are slow, and stay there.
  const auto without_tiny = [&](auto value) {
    return hn::IfThenElseZero(hn::Gt(hn::Abs(value), hn::Set(d, T(1e-35))), value);
  };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto g = hn::LoadU(d, gradient + i);
    const auto m = hn::MulAdd(b1, hn::Sub(hn::LoadU(d, mean + i), g), g);
    const auto g2 = hn::Mul(g, g);
    const auto v = hn::MulAdd(b2, hn::Sub(hn::LoadU(d, square + i), g2), g2);
    const auto root = hn::Add(hn::Sqrt(v), hn::Set(d, epsilon));
    const auto step = hn::Div(hn::Mul(hn::Set(d, rate), m), root);
    hn::StoreU(without_tiny(m), d, mean + i);
    hn::StoreU(without_tiny(v), d, square + i);
    hn::StoreU(hn::Sub(hn::LoadU(d, x + i), step), d, x + i);
  }
}

template <typename T>
HWY_INLINE void PairProductsOf(const T* a, int na, const T* b, int nb, int rows, bool symmetric,
                               T* out, int out_stride) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int a_stride = Padded(na), b_stride = Padded(nb);
  for (int n = 0; n < kBatch; ++n) {
    T* to = out + static_cast<std::size_t>(n) * out_stride;
    for (int i = 0; i < na; ++i) {
      const int first = symmetric ? i : 0;
      // A whole vector is written at the end of each run of pairs; the next run overwrites the
      // rest.
      for (int j = first; j < nb; j += lanes) {
        auto sum = hn::Zero(d);
        for (int r = 0; r < rows; ++r) {
          sum = hn::MulAdd(hn::Set(d, a[r * a_stride + i]), hn::LoadU(d, b + r * b_stride + j), sum);
        }
        hn::StoreU(sum, d, to + (j - first));
      }
      to += nb - first;
    }
    for (int j = 0; j < kPad; j += lanes) hn::StoreU(hn::Zero(d), d, to + j);
    a += rows * a_stride;
    b += rows * b_stride;
  }
}

// kBlockRows x kVectors vectors of c.
template <int kVectors, typename T>
HWY_INLINE void ProductBlock(const T* x, int x_stride, const T* y, int y_stride, double* c,
                             int c_stride) {
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  hn::Vec<decltype(d)> sum[kBlockRows][kVectors];
  for (auto& row : sum) {
    for (auto& s : row) s = hn::Zero(d);
  }
  for (int n = 0; n < kBatch; ++n) {
    hn::Vec<decltype(d)> from[kVectors];
    for (int v = 0; v < kVectors; ++v) from[v] = hn::LoadU(d, y + v * lanes);
    for (int i = 0; i < kBlockRows; ++i) {
      const auto factor = hn::Set(d, x[i]);
      for (int v = 0; v < kVectors; ++v) sum[i][v] = hn::MulAdd(factor, from[v], sum[i][v]);
    }
    x += x_stride;
    y += y_stride;
  }
  HWY_ALIGN T row[kVectors * HWY_MAX_BYTES / sizeof(T)];
  for (int i = 0; i < kBlockRows; ++i) {
    for (int v = 0; v < kVectors; ++v) hn::StoreU(sum[i][v], d, row + v * lanes);
    for (int j = 0; j < kVectors * lanes; ++j) c[i * c_stride + j] += row[j];
  }
}

template <typename T>
HWY_INLINE void AddProduct(const T* x, int p, int x_stride, const T* y, int q, int y_stride,
                           double* c) {
  const int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<T>()));
  const int c_stride = Padded(q);
  int j = 0;
  // The columns outermost: a panel of y stays in the first-level cache while x streams by.
  for (; j + kBlockVectors * lanes <= q + lanes - 1; j += kBlockVectors * lanes) {
    for (int i = 0; i < p; i += kBlockRows) {
      ProductBlock<kBlockVectors>(x + i, x_stride, y + j, y_stride, c + i * c_stride + j, c_stride);
    }
  }
  for (; j < q; j += lanes) {
    for (int i = 0; i < p; i += kBlockRows) {
      ProductBlock<1>(x + i, x_stride, y + j, y_stride, c + i * c_stride + j, c_stride);
    }
  }
}

// to[k] += alpha times the sum of the lanes of sum[k], k < kCount: four floats at a time, as their
// separate sums would take longer than the dot products do.
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
      for (int rest = k; rest < size; ++rest) total += x[i * x_stride + rest] * y[j * y_stride + rest];
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
#define PBNBRDF_KERNELS(T, Suffix)                                                              \
  void Dense##Suffix(const T* layer, int out, int in, const T* x, T* y) {                       \
    DenseBlocks<true>(layer, in + 1, 1, out, in, x, y);                                         \
  }                                                                                             \
  void DenseTransposed##Suffix(const T* layer, int out, int in, const T* y, T* x) {             \
    DenseBlocks<false>(layer, 1, in + 1, in, out, y, x);                                        \
  }                                                                                             \
  void Tanh##Suffix(T* x, std::size_t count) { TanhAll(x, count); }                             \
  void Exp##Suffix(T* x, std::size_t count) { ExpAll(x, count); }                               \
  void Relu##Suffix(T* x, std::size_t count) { ReluAll(x, count); }                             \
  void ReluSlopes##Suffix(const T* y, std::size_t count, T* delta) {                            \
    ReluSlopesAll(y, count, delta);                                                             \
  }                                                                                             \
  void AbsoluteLossGradient##Suffix(const T* z, const T* cos_i, const T* f, T log_weight,       \
                                    T chromaticity_weight, T* gradient) {                       \
    AbsoluteLossGradientOf(z, cos_i, f, log_weight, chromaticity_weight, gradient);             \
  }                                                                                             \
  void AddReflectanceSums##Suffix(const T* z, const T* weights, T* sums) {                      \
    AddReflectanceSumsOf(z, weights, sums);                                                     \
  }                                                                                             \
  void AdamStep##Suffix(std::size_t count, const T* gradient, T rate, T beta1, T beta2,         \
                        T epsilon, T* mean, T* square, T* x) {                                  \
    AdamStepOf(count, gradient, rate, beta1, beta2, epsilon, mean, square, x);                  \
  }                                                                                             \
  void AddRowProducts##Suffix(T alpha, const T* x, int rows_x, int x_stride, const T* y,        \
                              int rows_y, int y_stride, int size, T* c, int c_stride) {         \
    AddAllRowProducts(alpha, x, rows_x, x_stride, y, rows_y, y_stride, size, c, c_stride);      \
  }                                                                                             \
  void PairProducts##Suffix(const T* a, int na, const T* b, int nb, int rows, bool symmetric,   \
                            T* out, int out_stride) {                                           \
    PairProductsOf(a, na, b, nb, rows, symmetric, out, out_stride);                             \
  }                                                                                             \
  void AddTransposedProduct##Suffix(const T* x, int p, int x_stride, const T* y, int q,         \
                                    int y_stride, double* c) {                                  \
    AddProduct(x, p, x_stride, y, q, y_stride, c);                                              \
  }

PBNBRDF_KERNELS(float, F)
PBNBRDF_KERNELS(double, D)
#undef PBNBRDF_KERNELS

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

HWY_EXPORT(TargetName);
const char* InstructionSet() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

#define PBNBRDF_DISPATCH(T, Suffix)                                                             \
  HWY_EXPORT(Dense##Suffix);                                                                    \
  HWY_EXPORT(DenseTransposed##Suffix);                                                          \
  HWY_EXPORT(Tanh##Suffix);                                                                     \
  HWY_EXPORT(Exp##Suffix);                                                                      \
  HWY_EXPORT(Relu##Suffix);                                                                     \
  HWY_EXPORT(ReluSlopes##Suffix);                                                               \
  HWY_EXPORT(AbsoluteLossGradient##Suffix);                                                     \
  HWY_EXPORT(AddReflectanceSums##Suffix);                                                       \
  HWY_EXPORT(AdamStep##Suffix);                                                                 \
  HWY_EXPORT(AddRowProducts##Suffix);                                                           \
  HWY_EXPORT(PairProducts##Suffix);                                                             \
  HWY_EXPORT(AddTransposedProduct##Suffix);                                                     \
  template <>                                                                                   \
  void Dense(const T* layer, int out, int in, const T* x, T* y) {                               \
    HWY_DYNAMIC_DISPATCH(Dense##Suffix)(layer, out, in, x, y);                                  \
  }                                                                                             \
  template <>                                                                                   \
  void DenseTransposed(const T* layer, int out, int in, const T* y, T* x) {                     \
    HWY_DYNAMIC_DISPATCH(DenseTransposed##Suffix)(layer, out, in, y, x);                        \
  }                                                                                             \
  template <>                                                                                   \
  void Tanh(T* x, std::size_t count) {                                                          \
    HWY_DYNAMIC_DISPATCH(Tanh##Suffix)(x, count);                                               \
  }                                                                                             \
  template <>                                                                                   \
  void Exp(T* x, std::size_t count) {                                                           \
    HWY_DYNAMIC_DISPATCH(Exp##Suffix)(x, count);                                                \
  }                                                                                             \
  template <>                                                                                   \
  void Relu(T* x, std::size_t count) {                                                          \
    HWY_DYNAMIC_DISPATCH(Relu##Suffix)(x, count);                                               \
  }                                                                                             \
  template <>                                                                                   \
  void ReluSlopes(const T* y, std::size_t count, T* delta) {                                    \
    HWY_DYNAMIC_DISPATCH(ReluSlopes##Suffix)(y, count, delta);                                  \
  }                                                                                             \
  template <>                                                                                   \
  void AbsoluteLossGradient(const T* z, const T* cos_i, const T* f, T log_weight,               \
                            T chromaticity_weight, T* gradient) {                               \
    HWY_DYNAMIC_DISPATCH(AbsoluteLossGradient##Suffix)                                          \
    (z, cos_i, f, log_weight, chromaticity_weight, gradient);                                   \
  }                                                                                             \
  template <>                                                                                   \
  void AddReflectanceSums(const T* z, const T* weights, T* sums) {                              \
    HWY_DYNAMIC_DISPATCH(AddReflectanceSums##Suffix)(z, weights, sums);                         \
  }                                                                                             \
  template <>                                                                                   \
  void AdamStep(std::size_t count, const T* gradient, T rate, T beta1, T beta2, T epsilon,      \
                T* mean, T* square, T* x) {                                                     \
    HWY_DYNAMIC_DISPATCH(AdamStep##Suffix)                                                      \
    (count, gradient, rate, beta1, beta2, epsilon, mean, square, x);                            \
  }                                                                                             \
  template <>                                                                                   \
  void AddRowProducts(T alpha, const T* x, int rows_x, int x_stride, const T* y, int rows_y,    \
                      int y_stride, int size, T* c, int c_stride) {                             \
    HWY_DYNAMIC_DISPATCH(AddRowProducts##Suffix)                                                \
    (alpha, x, rows_x, x_stride, y, rows_y, y_stride, size, c, c_stride);                       \
  }                                                                                             \
  template <>                                                                                   \
  void PairProducts(const T* a, int na, const T* b, int nb, int rows, bool symmetric, T* out,   \
                    int out_stride) {                                                           \
    HWY_DYNAMIC_DISPATCH(PairProducts##Suffix)(a, na, b, nb, rows, symmetric, out, out_stride); \
  }                                                                                             \
  template <>                                                                                   \
  void AddTransposedProduct(const T* x, int p, int x_stride, const T* y, int q, int y_stride,   \
                            double* c) {                                                        \
    HWY_DYNAMIC_DISPATCH(AddTransposedProduct##Suffix)(x, p, x_stride, y, q, y_stride, c);      \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
