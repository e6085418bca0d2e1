// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/passes.h"

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "passes.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

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

struct ReluOf {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    return AtLeast(d, 0, x);
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

// DenseBlock<rows>, 1 <= rows <= kMaxRows.
template <int kMaxRows, bool kBias, class Activation, typename T>
HWY_INLINE void DenseRows(int rows, const T* w, int stride_o, int stride_i, int in, const T* x,
                          T* y) {
  if (rows == kMaxRows) {
    DenseBlock<kMaxRows, kBias, Activation>(w, stride_o, stride_i, in, x, y);
  } else if constexpr (kMaxRows > 1) {
    DenseRows<kMaxRows - 1, kBias, Activation>(rows, w, stride_o, stride_i, in, x, y);
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
HWY_INLINE void ExpAll(T* x, std::size_t count) {
  const hn::ScalableTag<T> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::StoreU(hn::Exp(d, hn::LoadU(d, x + i)), d, x + i);
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

// The exported names: one for each precision, as HWY_EXPORT wants plain functions.
#define PBNBRDF_KERNELS(T, Suffix)                                                  \
  void Dense##Suffix(const T* layer, int out, int in, const T* x, T* y) {           \
    DenseBlocks<true, Linear>(layer, in + 1, 1, out, in, x, y);                     \
  }                                                                                 \
  void DenseTanh##Suffix(const T* layer, int out, int in, const T* x, T* y) {       \
    DenseBlocks<true, TanhOf>(layer, in + 1, 1, out, in, x, y);                     \
  }                                                                                 \
  void DenseRelu##Suffix(const T* layer, int out, int in, const T* x, T* y) {       \
    DenseBlocks<true, ReluOf>(layer, in + 1, 1, out, in, x, y);                     \
  }                                                                                 \
  void DenseTransposed##Suffix(const T* layer, int out, int in, const T* y, T* x) { \
    DenseBlocks<false, Linear>(layer, 1, in + 1, in, out, y, x);                    \
  }                                                                                 \
  void Exp##Suffix(T* x, std::size_t count) { ExpAll(x, count); }                   \
  void ReluSlopes##Suffix(const T* y, std::size_t count, T* delta) {                \
    ReluSlopesAll(y, count, delta);                                                 \
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

#define PBNBRDF_DISPATCH(T, Suffix)                                         \
  HWY_EXPORT(Dense##Suffix);                                                \
  HWY_EXPORT(DenseTanh##Suffix);                                            \
  HWY_EXPORT(DenseRelu##Suffix);                                            \
  HWY_EXPORT(DenseTransposed##Suffix);                                      \
  HWY_EXPORT(Exp##Suffix);                                                  \
  HWY_EXPORT(ReluSlopes##Suffix);                                           \
  template <>                                                               \
  void Dense(const T* layer, int out, int in, const T* x, T* y) {           \
    HWY_DYNAMIC_DISPATCH(Dense##Suffix)(layer, out, in, x, y);              \
  }                                                                         \
  template <>                                                               \
  void DenseTanh(const T* layer, int out, int in, const T* x, T* y) {       \
    HWY_DYNAMIC_DISPATCH(DenseTanh##Suffix)(layer, out, in, x, y);          \
  }                                                                         \
  template <>                                                               \
  void DenseRelu(const T* layer, int out, int in, const T* x, T* y) {       \
    HWY_DYNAMIC_DISPATCH(DenseRelu##Suffix)(layer, out, in, x, y);          \
  }                                                                         \
  template <>                                                               \
  void DenseTransposed(const T* layer, int out, int in, const T* y, T* x) { \
    HWY_DYNAMIC_DISPATCH(DenseTransposed##Suffix)(layer, out, in, y, x);    \
  }                                                                         \
  template <>                                                               \
  void Exp(T* x, std::size_t count) {                                       \
    HWY_DYNAMIC_DISPATCH(Exp##Suffix)(x, count);                            \
  }                                                                         \
  template <>                                                               \
  void ReluSlopes(const T* y, std::size_t count, T* delta) {                \
    HWY_DYNAMIC_DISPATCH(ReluSlopes##Suffix)(y, count, delta);              \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

HWY_EXPORT(TargetName);
const char* InstructionSet() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
