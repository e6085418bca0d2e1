// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "network/evaluation.h"

#include "kernels/disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "network/evaluation.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/highway.h>

#include "kernels/kernels.h"
#include "network/float_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::HWY_NAMESPACE {
namespace {

using kernels::kBatch;
using Vector3 = std::array<V, 3>;

#include "pbnbrdf/brdf/half_diff-inl.h"
#include "pbnbrdf/network/expressions-inl.h"

// The sum and the difference of the two vectors of Lanes(F()) direction pairs. pairs: the components of
// wi, wo, wi, ... Computed in double precision, then rounded to single: near the mirror direction most digits cancel
// in the sum, and theta_h depends on those that remain.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE std::array<Vector3, 2> AddAndSubtract(const double* pairs) {
  const auto sum = [&](int i) HWY_ATTR { return V(pairs[i] + pairs[3 + i]); };
  const auto difference = [&](int i) HWY_ATTR { return V(pairs[i] - pairs[3 + i]); };
  return {{{sum(0), sum(1), sum(2)}, {difference(0), difference(1), difference(2)}}};
}
#else
HWY_INLINE std::array<Vector3, 2> AddAndSubtract(const double* pairs) {
  const F d;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  using VD = hn::Vec<decltype(dd)>;
  using VH = hn::Vec<decltype(half)>;
  // The vectors' numbers come in the order wi, wo, wi, ...: the even ones become wi + wo, the odd ones
  // wi - wo.
  const VD sign = hn::OddEven(hn::Set(dd, -1.0), hn::Set(dd, 1.0));
  VH mixed[3][4];
  for (int k = 0; k < 4; ++k) {
    VD v[3];
    hn::LoadInterleaved3(dd, pairs + k * 3 * hn::Lanes(dd), v[0], v[1], v[2]);
    for (int i = 0; i < 3; ++i) {
      mixed[i][k] = hn::DemoteTo(half, hn::MulAdd(v[i], sign, hn::Reverse2(dd, v[i])));
    }
  }
  const auto low = [&](int i) HWY_ATTR { return hn::Combine(d, mixed[i][1], mixed[i][0]); };
  const auto high = [&](int i) HWY_ATTR { return hn::Combine(d, mixed[i][3], mixed[i][2]); };
  const auto sum = [&](int i) HWY_ATTR { return V(hn::ConcatEven(d, high(i), low(i))); };
  const auto difference = [&](int i) HWY_ATTR { return V(hn::ConcatOdd(d, high(i), low(i))); };
  return {{{sum(0), sum(1), sum(2)}, {difference(0), difference(1), difference(2)}}};
}
#endif

template <class Expression>
HWY_FLATTEN void EncodeAll(const double* pairs, float* inputs, Expression expression) {
  const int lanes = static_cast<int>(hn::Lanes(F()));
  for (int n = 0; n < kBatch; n += lanes) {
    const auto [sum, difference] = AddAndSubtract(pairs + 6 * n);
    const Inputs<V> encoded = expression(HalfDiffFromSum(sum, difference));
    for (int i = 0; i < kEncodedSize; ++i) hn::StoreU(encoded[i].v, F(), inputs + i * kBatch + n);
  }
}

void Encode(Encoding encoding, const double* pairs, float* inputs) {
  switch (encoding) {
#define PBNBRDF_CASE(enumerator, name, expression, ...) \
  case Encoding::enumerator:                            \
    return EncodeAll(pairs, inputs, [](const auto& v) HWY_ATTR { return expression(v); });
    PBNBRDF_ENCODINGS(PBNBRDF_CASE)
#undef PBNBRDF_CASE
  }
}

HWY_INLINE hn::Vec<F> ReflectanceOf(const float* z) {
  return ClampedReflectance(V(hn::LoadU(F(), z))).v;
}

HWY_FLATTEN void Reflectances(const float* z, double* f) {
  const F d;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int half_lanes = static_cast<int>(hn::Lanes(dd));
  HWY_ALIGN float rgb[3 * HWY_MAX_BYTES / sizeof(float)];
  for (int n = 0; n < kBatch; n += lanes, f += 3 * lanes) {
    hn::StoreInterleaved3(ReflectanceOf(z + n), ReflectanceOf(z + kBatch + n),
                          ReflectanceOf(z + 2 * kBatch + n), d, rgb);
    for (int i = 0; i < 3 * lanes; i += half_lanes) {
      hn::StoreU(hn::PromoteTo(dd, hn::LoadU(half, rgb + i)), dd, f + i);
    }
  }
}

}  // namespace
}  // namespace pbnbrdf::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf {

HWY_EXPORT(Encode);
HWY_EXPORT(Reflectances);

static_assert(sizeof(DirectionPair) == 6 * sizeof(double) && sizeof(Rgb) == 3 * sizeof(double));

void EncodeBatch(Encoding encoding, const DirectionPair* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(Encode)(encoding, &pairs->wi.x, inputs);
}

void ReflectanceBatch(const float* z, Rgb* f) { HWY_DYNAMIC_DISPATCH(Reflectances)(z, f->data()); }

}  // namespace pbnbrdf
#endif  // HWY_ONCE
