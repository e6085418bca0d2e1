// float_vector-inl.h: the operations of brdf/operations.h on vectors of float. Included once for each
// instruction set, after foreach_target.h.

// Highway's own form of #pragma once for such files.
#if defined(PBNBRDF_FLOAT_VECTOR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PBNBRDF_FLOAT_VECTOR_INL_H
#undef PBNBRDF_FLOAT_VECTOR_INL_H
#else
#define PBNBRDF_FLOAT_VECTOR_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "kernels/float_math-inl.h"
#include "pbnbrdf/brdf/operations.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace math = kernels::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;

// A number of each of Lanes(F()) direction pairs. Compilers may contract products and sums to fused
// multiply-adds.
struct FloatVector {
  HWY_INLINE FloatVector(hn::Vec<F> vector) : v(vector) {}
  HWY_INLINE FloatVector(double x) : v(hn::Set(F(), static_cast<float>(x))) {}
  hn::Vec<F> v;
};
using V = FloatVector;

HWY_INLINE V operator+(V a, V b) { return hn::Add(a.v, b.v); }
HWY_INLINE V operator-(V a, V b) { return hn::Sub(a.v, b.v); }
HWY_INLINE V operator*(V a, V b) { return hn::Mul(a.v, b.v); }
HWY_INLINE V operator/(V a, double b) { return a * (1.0 / b); }

HWY_INLINE V Min(V a, V b) { return hn::Min(a.v, b.v); }
HWY_INLINE V floor(V x) { return hn::Floor(x.v); }
HWY_INLINE V log(V x) { return hn::Log(F(), x.v); }

HWY_INLINE V IfGreater(V a, V b, V yes, V no) {
  return hn::IfThenElse(hn::Gt(a.v, b.v), yes.v, no.v);
}

// The inverse is 0 for x < 1e-36: the squares of such lengths are hardly more than denormal.
HWY_INLINE Roots<V> ToRoots(V x) {
  constexpr double kTiny = 1e-36;
  if constexpr (math::kHas14BitReciprocals) {
    const V inverse = IfGreater(x, kTiny, math::ReciprocalSqrt(F(), x.v), 0.0);
    return {x * inverse, inverse};
  }
  const V root = hn::Sqrt(x.v);
  return {root, IfGreater(x, kTiny, hn::Div(V(1.0).v, root.v), 0.0)};
}

HWY_INLINE V sqrt(V x) { return ToRoots(x).root; }

HWY_INLINE Polar<V> ToPolar(V x, V y, V scale) {
  const auto [length, inverse] = ToRoots(x * x + y * y);
  return {length * scale, IfGreater(inverse, 0.0, x * inverse, 1.0), y * inverse};
}

HWY_INLINE V AngleOf(V sine, V cosine) { return math::AngleOf(F(), sine.v, cosine.v); }

// For 0 <= x < 88.
HWY_INLINE V expm1(V x) { return math::FastExpm1(F(), x.v); }

}  // namespace pbnbrdf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PBNBRDF_FLOAT_VECTOR_INL_H
