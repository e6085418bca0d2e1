// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/losses.h"

#include <limits>

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "losses.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "target-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

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
    const V slope = hn::Div(hn::Mul(hn::Add(f, one), cos), hn::Add(u, one));
    // At normal incidence log1p(expm1(x)) is x; computed, it is the logarithm of 0 from -37 down.
    const auto normal = hn::Eq(cos, one);
    const V exact_log = hn::IfThenElse(normal, x, log);
    hn::StoreU(hn::Sub(hn::LoadU(d, targets + k), exact_log), d, residuals + k);
    hn::StoreU(hn::Neg(hn::IfThenElse(normal, one, slope)), d, slopes + k);
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
  // Beyond, where no reflectance lies, the gradient has come to its limit and f^ would overflow.
  const auto largest = hn::Set(d, T(40));
  for (int n = 0; n < kBatch; n += static_cast<int>(hn::Lanes(d))) {
    const auto cos = hn::LoadU(d, cos_i + n), cos2 = hn::Mul(cos, cos);
    hn::Vec<decltype(d)> grown[3], fit[3];
    auto norm = hn::Zero(d), norm_fit = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
      grown[c] = hn::Exp(d, hn::Min(largest, hn::LoadU(d, z + c * kBatch + n)));
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

// The exported names: one for each precision, as HWY_EXPORT wants plain functions.
#define PBNBRDF_KERNELS(T, Suffix)                                                        \
  void LogResiduals##Suffix(const T* z, const double* targets, const double* cos_i,       \
                            double* residuals, double* slopes) {                          \
    AllLogResiduals(z, targets, cos_i, residuals, slopes);                                \
  }                                                                                       \
  void AbsoluteLossGradient##Suffix(const T* z, const T* cos_i, const T* f, T log_weight, \
                                    T chromaticity_weight, T* gradient) {                 \
    AbsoluteLossGradientOf(z, cos_i, f, log_weight, chromaticity_weight, gradient);       \
  }                                                                                       \
  void AddReflectanceSums##Suffix(const T* z, const T* weights, T* sums) {                \
    AddReflectanceSumsOf(z, weights, sums);                                               \
  }

PBNBRDF_KERNELS(float, F)
PBNBRDF_KERNELS(double, D)
#undef PBNBRDF_KERNELS

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

#define PBNBRDF_DISPATCH(T, Suffix)                                                            \
  HWY_EXPORT(LogResiduals##Suffix);                                                            \
  HWY_EXPORT(AbsoluteLossGradient##Suffix);                                                    \
  HWY_EXPORT(AddReflectanceSums##Suffix);                                                      \
  template <>                                                                                  \
  void LogResiduals(const T* z, const double* targets, const double* cos_i, double* residuals, \
                    double* slopes) {                                                          \
    HWY_DYNAMIC_DISPATCH(LogResiduals##Suffix)(z, targets, cos_i, residuals, slopes);          \
  }                                                                                            \
  template <>                                                                                  \
  void AbsoluteLossGradient(const T* z, const T* cos_i, const T* f, T log_weight,              \
                            T chromaticity_weight, T* gradient) {                              \
    HWY_DYNAMIC_DISPATCH(AbsoluteLossGradient##Suffix)                                         \
    (z, cos_i, f, log_weight, chromaticity_weight, gradient);                                  \
  }                                                                                            \
  template <>                                                                                  \
  void AddReflectanceSums(const T* z, const T* weights, T* sums) {                             \
    HWY_DYNAMIC_DISPATCH(AddReflectanceSums##Suffix)(z, weights, sums);                        \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
