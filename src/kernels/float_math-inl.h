// float_math-inl.h: elementary functions of vectors of float, cheaper than those of hwy/contrib/math, and
// the number of registers. Included once for each instruction set, after foreach_target.h.

// Highway's own form of #pragma once for such files.
#if defined(PBNBRDF_FLOAT_MATH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PBNBRDF_FLOAT_MATH_INL_H
#undef PBNBRDF_FLOAT_MATH_INL_H
#else
#define PBNBRDF_FLOAT_MATH_INL_H
#endif

#include <hwy/highway.h>

#include "minimax.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 32 vector registers rather than 16.
inline constexpr bool kManyRegisters = HWY_MAX_BYTES >= 64 || HWY_ARCH_ARM_A64;

// HWY_TARGET is smaller for better instruction sets.
#undef PBNBRDF_HAS_AVX512
#define PBNBRDF_HAS_AVX512 (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3)

// AVX-512 approximates 1 / x and 1 / sqrt(x) to 14 bits, which one step of Newton's method doubles.
// Elsewhere there are fewer bits, and division is fast enough.
inline constexpr bool kHas14BitReciprocals = PBNBRDF_HAS_AVX512;

// x, but at least or at most a bound; a NaN stays one. On x86 max and min return their second operand where one is
// NaN; on arm64 they return the other one.
template <class D, class V>
HWY_INLINE V AtLeast(D d, hn::TFromD<D> least, V x) {
  const V bound = hn::Set(d, least);
  return HWY_ARCH_X86 ? hn::Max(bound, x) : hn::IfThenElse(hn::Lt(x, bound), bound, x);
}
template <class D, class V>
HWY_INLINE V AtMost(D d, hn::TFromD<D> most, V x) {
  const V bound = hn::Set(d, most);
  return HWY_ARCH_X86 ? hn::Min(bound, x) : hn::IfThenElse(hn::Gt(x, bound), bound, x);
}

// 1 / x for normal x, relative error below 2e-7.
template <class D, class V>
HWY_INLINE V Reciprocal(D d, V x) {
  if constexpr (!kHas14BitReciprocals) return hn::Div(hn::Set(d, 1.0f), x);
  const V r = hn::ApproximateReciprocal(x);
  return hn::Mul(r, hn::NegMulAdd(x, r, hn::Set(d, 2.0f)));
}

// 1 / sqrt(x) for normal x > 0, relative error below 3e-7.
template <class D, class V>
HWY_INLINE V ReciprocalSqrt(D d, V x) {
  if constexpr (!kHas14BitReciprocals) return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));
  const V r = hn::ApproximateReciprocalSqrt(x);
  const V half = hn::Mul(hn::Set(d, 0.5f), hn::Mul(x, r));
  return hn::Mul(r, hn::NegMulAdd(half, r, hn::Set(d, 1.5f)));
}

// coefficients[0] + coefficients[1] x + ...
template <int kSize, class D, class V>
HWY_INLINE V Polynomial(D d, V x, const float (&coefficients)[kSize]) {
  V sum = hn::Set(d, coefficients[kSize - 1]);
  for (int i = kSize - 2; i >= 0; --i) sum = hn::MulAdd(sum, x, hn::Set(d, coefficients[i]));
  return sum;
}

#if PBNBRDF_HAS_AVX512
// values[index mod kTanhIntervals] for each index of the vector.
HWY_INLINE hn::Vec512<float> LookUp(const float* values, hn::Vec512<std::int32_t> index) {
  return hn::Vec512<float>{
      _mm512_permutex2var_ps(_mm512_load_ps(values), index.raw, _mm512_load_ps(values + 16))};
}

// Absolute error below 2e-7; odd, within [-1, 1], NaN for NaN. Here tables in registers are cheaper
// than a reciprocal.
template <class D, class V>
HWY_INLINE V FastTanh(D d, V x) {
  constexpr float kRound = 12582912.0f;  // the last bit of 1.5 * 2^23 is worth 1
  constexpr float kMaxArgument = (kTanhIntervals - 0.55f) * kTanhWidth;
  const V size = AtMost(d, kMaxArgument, hn::Abs(x));
  const V interval = hn::MulAdd(size, hn::Set(d, 1.0f / kTanhWidth), hn::Set(d, kRound));
  const auto index = hn::BitCast(hn::RebindToSigned<D>(), interval);
  const V r = hn::NegMulAdd(hn::Sub(interval, hn::Set(d, kRound)), hn::Set(d, kTanhWidth), size);
  V sum = LookUp(kTanhTable[5], index);
  for (int j = 4; j >= 0; --j) sum = hn::MulAdd(sum, r, LookUp(kTanhTable[j], index));
  return hn::CopySignToAbs(sum, x);
}
#else
// Absolute error below 4e-7; odd, within [-1, 1], NaN for NaN.
template <class D, class V>
HWY_INLINE V FastTanh(D d, V x) {
  const V x2 = hn::Min(hn::Set(d, kTanhMost * kTanhMost), hn::Mul(x, x));
  const V p = hn::Mul(x, Polynomial(d, x2, kTanhNumerator));
  const V q = Polynomial(d, x2, kTanhDenominator);
  const V ratio = hn::Div(p, q);
  const V clamped = hn::Min(hn::Set(d, 1.0f), hn::Max(hn::Set(d, -1.0f), ratio));
  return hn::IfThenElse(hn::IsNaN(x), x, clamped);
}
#endif

// expm1(x) for 0 <= x < 88, relative error below 4e-7: 2^n (1 + expm1(r)) - 1 with x = n log 2 + r.
template <class D, class V>
HWY_INLINE V FastExpm1(D d, V x) {
  const hn::RebindToSigned<D> di;
  const V n = hn::Round(hn::Mul(x, hn::Set(d, kPerLog2)));
  const V r = hn::NegMulAdd(n, hn::Set(d, kLog2Low), hn::NegMulAdd(n, hn::Set(d, kLog2High), x));
  const V p = hn::MulAdd(hn::Mul(r, r), Polynomial(d, r, kExpm1Polynomial), r);
  const auto exponent = hn::Add(hn::ConvertTo(di, n), hn::Set(di, 127));
  const V scale = hn::BitCast(d, hn::ShiftLeft<23>(exponent));  // 2^n
  return hn::MulAdd(scale, p, hn::Sub(scale, hn::Set(d, 1.0f)));
}

// The angle in [0, pi] of the given sine >= 0 and cosine, relative error below 4e-7:
// 2 atan(t), t = sine / (1 + cosine), for the acute one.
template <class D, class V>
HWY_INLINE V AngleOf(D d, V sine, V cosine) {
  constexpr float kPi = 3.14159265f;
  const V t = hn::Mul(sine, Reciprocal(d, hn::Add(hn::Set(d, 1.0f), hn::Abs(cosine))));
  const V acute = hn::Mul(t, Polynomial(d, hn::Mul(t, t), kTwoAtanPolynomial));
  return hn::IfThenElse(hn::Lt(cosine, hn::Zero(d)), hn::Sub(hn::Set(d, kPi), acute), acute);
}

}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PBNBRDF_FLOAT_MATH_INL_H
