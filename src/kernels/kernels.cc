// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "pbnbrdf/kernels/kernels.h"

#include <limits>

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/cache_control.h>
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

// 32 vector registers rather than 16.
constexpr bool kManyRegisters = HWY_MAX_BYTES >= 64 || HWY_ARCH_ARM_A64;

// Rows of the register block of AddProduct: 3 vectors wide, it fills the register file.
constexpr int kBlockRows = kManyRegisters ? 8 : 4;
constexpr int kRowProductRows = HWY_MAX_BYTES >= 64 ? 4 : 2;

// Rows of the register block of Dense, of two vectors each.
constexpr int kDenseRows = kManyRegisters ? 7 : 6;

struct Linear {
  template <class D, class V>
  HWY_INLINE V operator()(D, V x) const {
    return x;
  }
};

struct TanhOf {
  template <class V>
  HWY_INLINE V operator()(hn::ScalableTag<float> d, V x) const {
    return FastTanh(d, x);
  }
  template <class V>
  HWY_INLINE V operator()(hn::ScalableTag<double> d, V x) const {
    return hn::Tanh(d, x);
  }
};

// kRows outputs; W is read as w[o * stride_o + i * stride_i].
template <int kRows, bool kBias, class Activation, typename T>
HWY_INLINE void DenseBlock(const T* w, int stride_o, int stride_i, int in, const T* x, T* y) {
  constexpr int kVectors = kManyRegisters && kRows <= 3 ? 4 : 2;  // chains enough to hide latency
  const hn::ScalableTag<T> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int n = 0; n < kBatch; n += kVectors * lanes) {
    hn::Vec<decltype(d)> sum[kRows][kVectors];
    for (int o = 0; o < kRows; ++o) {
      for (auto& s : sum[o]) s = kBias ? hn::Set(d, w[o * stride_o + in * stride_i]) : hn::Zero(d);
    }
    for (int i = 0; i < in; ++i) {
      hn::Vec<decltype(d)> from[kVectors];
      for (int v = 0; v < kVectors; ++v) from[v] = hn::LoadU(d, x + i * kBatch + n + v * lanes);
      for (int o = 0; o < kRows; ++o) {
        const auto weight = hn::Set(d, w[o * stride_o + i * stride_i]);
        for (int v = 0; v < kVectors; ++v) sum[o][v] = hn::MulAdd(weight, from[v], sum[o][v]);
      }
    }
    for (int o = 0; o < kRows; ++o) {
      for (int v = 0; v < kVectors; ++v) {
        hn::StoreU(Activation()(d, sum[o][v]), d, y + o * kBatch + n + v * lanes);
      }
    }
  }
}

// DenseBlock<rows>, 1 <= rows <= kMostRows.
template <int kMostRows, bool kBias, class Activation, typename T>
HWY_INLINE void DenseRows(int rows, const T* w, int stride_o, int stride_i, int in, const T* x,
                          T* y) {
  if (rows == kMostRows) {
    DenseBlock<kMostRows, kBias, Activation>(w, stride_o, stride_i, in, x, y);
  } else if constexpr (kMostRows > 1) {
    DenseRows<kMostRows - 1, kBias, Activation>(rows, w, stride_o, stride_i, in, x, y);
  }
}

// In blocks of about equal size.
template <bool kBias, class Activation, typename T>
HWY_INLINE void DenseBlocks(const T* w, int stride_o, int stride_i, int out, int in, const T* x,
                            T* y) {
  const int blocks = (out + kDenseRows - 1) / kDenseRows;
  for (int b = 0; b < blocks; ++b) {
    const int begin = b * out / blocks, end = (b + 1) * out / blocks;
    DenseRows<kDenseRows, kBias, Activation>(end - begin, w + begin * stride_o, stride_o, stride_i,
                                             in, x, y + begin * kBatch);
  }
}

template <typename T>
HWY_INLINE void TanhAll(T* x, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(TanhOf()(d, hn::LoadU(d, x + i)), d, x + i);
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

// ProductBlock<rows, kVectors>, 1 <= rows <= kMostRows.
template <int kMostRows, int kVectors, typename T>
HWY_INLINE void ProductRows(int rows, const T* x, const T* y, int y_stride, double* c,
                            int c_stride) {
  if (rows == kMostRows) {
    ProductBlock<kMostRows, kVectors>(x, y, y_stride, c, c_stride);
  } else if constexpr (kMostRows > 1) {
    ProductRows<kMostRows - 1, kVectors>(rows, x, y, y_stride, c, c_stride);
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

template <typename T>
HWY_INLINE void AllLogResiduals(const T* z, const double* targets, const double* cos_i,
                                double* residuals, double* slopes) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<T, decltype(d)> from;
  using V = hn::Vec<decltype(d)>;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const V one = hn::Set(d, 1.0);
  for (int k = 0; k < 3 * kBatch; k += static_cast<int>(hn::Lanes(d))) {
    V x;
    if constexpr (sizeof(T) == sizeof(double)) {
      x = hn::LoadU(d, z + k);
    } else {
      x = hn::PromoteTo(d, hn::LoadU(from, z + k));
    }
    const V cos = hn::LoadU(d, cos_i + k % kBatch);
    const V f = hn::Expm1(d, x);
    const V u = hn::Mul(f, cos);
    // The functions above take neither what overflows nor what isn't finite.
    const V overflow = hn::IfThenElseZero(hn::Gt(x, hn::Set(d, 706.0)), hn::Set(d, kInfinity));
    const V log = hn::Add(hn::MulAdd(hn::Zero(d), x, overflow), hn::Log1p(d, u));
    hn::StoreU(hn::Sub(hn::LoadU(d, targets + k), log), d, residuals + k);
    const V slope = hn::Div(hn::Mul(hn::Add(f, one), cos), hn::Add(u, one));
    hn::StoreU(hn::Neg(slope), d, slopes + k);
  }
}

// The exported names: one for each precision, as HWY_EXPORT wants plain functions.
#define PBNBRDF_KERNELS(T, Suffix)                                                              \
  void Dense##Suffix(const T* layer, int out, int in, const T* x, T* y) {                       \
    DenseBlocks<true, Linear>(layer, in + 1, 1, out, in, x, y);                                 \
  }                                                                                             \
  void DenseTanh##Suffix(const T* layer, int out, int in, const T* x, T* y) {                   \
    DenseBlocks<true, TanhOf>(layer, in + 1, 1, out, in, x, y);                                 \
  }                                                                                             \
  void DenseTransposed##Suffix(const T* layer, int out, int in, const T* y, T* x) {             \
    DenseBlocks<false, Linear>(layer, 1, in + 1, in, out, y, x);                                \
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
  void PairProducts##Suffix(const T* a, int na, const T* b, int nb, bool symmetric, T* out,     \
                            int out_stride) {                                                   \
    PairProductsOf(a, na, b, nb, symmetric, out, out_stride);                                   \
  }                                                                                             \
  void SummedPairProducts##Suffix(const T* a, int na, const T* b, int nb, int rows,             \
                                  bool symmetric, T* out) {                                     \
    SummedPairProductsOf(a, na, b, nb, rows, symmetric, out);                                   \
  }                                                                                             \
  void AddProduct##Suffix(const T* x, int p, const T* y, int q, int y_stride, double* c) {      \
    AddProductOf(x, p, y, q, y_stride, c);                                                      \
  }                                                                                             \
  void LogResiduals##Suffix(const T* z, const double* targets, const double* cos_i,             \
                            double* residuals, double* slopes) {                                \
    AllLogResiduals(z, targets, cos_i, residuals, slopes);                                      \
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
  HWY_EXPORT(DenseTanh##Suffix);                                                                \
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
  HWY_EXPORT(SummedPairProducts##Suffix);                                                       \
  HWY_EXPORT(AddProduct##Suffix);                                                               \
  HWY_EXPORT(LogResiduals##Suffix);                                                             \
  template <>                                                                                   \
  void Dense(const T* layer, int out, int in, const T* x, T* y) {                               \
    HWY_DYNAMIC_DISPATCH(Dense##Suffix)(layer, out, in, x, y);                                  \
  }                                                                                             \
  template <>                                                                                   \
  void DenseTanh(const T* layer, int out, int in, const T* x, T* y) {                           \
    HWY_DYNAMIC_DISPATCH(DenseTanh##Suffix)(layer, out, in, x, y);                              \
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
  void PairProducts(const T* a, int na, const T* b, int nb, bool symmetric, T* out,             \
                    int out_stride) {                                                           \
    HWY_DYNAMIC_DISPATCH(PairProducts##Suffix)(a, na, b, nb, symmetric, out, out_stride);       \
  }                                                                                             \
  template <>                                                                                   \
  void SummedPairProducts(const T* a, int na, const T* b, int nb, int rows, bool symmetric,     \
                          T* out) {                                                             \
    HWY_DYNAMIC_DISPATCH(SummedPairProducts##Suffix)(a, na, b, nb, rows, symmetric, out);       \
  }                                                                                             \
  template <>                                                                                   \
  void AddProduct(const T* x, int p, const T* y, int q, int y_stride, double* c) {              \
    HWY_DYNAMIC_DISPATCH(AddProduct##Suffix)(x, p, y, q, y_stride, c);                          \
  }                                                                                             \
  template <>                                                                                   \
  void LogResiduals(const T* z, const double* targets, const double* cos_i, double* residuals,  \
                    double* slopes) {                                                           \
    HWY_DYNAMIC_DISPATCH(LogResiduals##Suffix)(z, targets, cos_i, residuals, slopes);           \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
