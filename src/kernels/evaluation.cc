// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/evaluation.h"

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "evaluation.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

using F = hn::ScalableTag<float>;
using V = hn::Vec<F>;

// The sums and the differences of the two vectors of Lanes(F()) direction pairs.
struct SumsAndDifferences {
  V sum[3], difference[3];
};

// In double precision, rounded to single in the end: near the mirror direction theta_h lives of the
// digits that cancel in the sum.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE SumsAndDifferences AddAndSubtract(const double* pairs) {
  SumsAndDifferences result;
  for (int i = 0; i < 3; ++i) {
    result.sum[i] = hn::Set(F(), static_cast<float>(pairs[i] + pairs[3 + i]));
    result.difference[i] = hn::Set(F(), static_cast<float>(pairs[i] - pairs[3 + i]));
  }
  return result;
}
#else
HWY_INLINE SumsAndDifferences AddAndSubtract(const double* pairs) {
  const F d;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  using VD = hn::Vec<decltype(dd)>;
  using VH = hn::Vec<decltype(half)>;
  // In lane order wi, wo, wi, ...: the even lanes become wi + wo, the odd ones wi - wo.
  const VD sign = hn::OddEven(hn::Set(dd, -1.0), hn::Set(dd, 1.0));
  VH mixed[3][4];
  for (int k = 0; k < 4; ++k) {
    VD v[3];
    hn::LoadInterleaved3(dd, pairs + k * 3 * hn::Lanes(dd), v[0], v[1], v[2]);
    for (int i = 0; i < 3; ++i) {
      mixed[i][k] = hn::DemoteTo(half, hn::MulAdd(v[i], sign, hn::Reverse2(dd, v[i])));
    }
  }
  SumsAndDifferences result;
  for (int i = 0; i < 3; ++i) {
    const V low = hn::Combine(d, mixed[i][1], mixed[i][0]);
    const V high = hn::Combine(d, mixed[i][3], mixed[i][2]);
    result.sum[i] = hn::ConcatEven(d, high, low);
    result.difference[i] = hn::ConcatOdd(d, high, low);
  }
  return result;
}
#endif

// What all encodings are made of (brdf/half_diff.h).
struct HalfDiffVectors {
  V sin_h, cos_h;      // of theta_h
  V sin_phi, cos_phi;  // of phi_h
  V dx, dy, dz;
};

// |x| as 1 / |x|, of the squared length: 0 at 0.
HWY_INLINE V InverseLength(V squared) {
  const F d;
  // Below this the squares are denormal.
  return hn::IfThenElseZero(hn::Gt(squared, hn::Set(d, 1e-36f)), ReciprocalSqrt(d, squared));
}

HWY_INLINE HalfDiffVectors ToHalfDiffVectors(const double* pairs) {
  const F d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
  const auto [sum, difference] = AddAndSubtract(pairs);
  const V tangential2 = hn::MulAdd(sum[0], sum[0], hn::Mul(sum[1], sum[1]));
  const V length2 = hn::MulAdd(sum[2], sum[2], tangential2);
  const V per_tangential = InverseLength(tangential2), per_length = InverseLength(length2);
  const auto at_pole = hn::Eq(per_tangential, zero);
  HalfDiffVectors v;
  v.cos_phi = hn::IfThenElse(at_pole, one, hn::Mul(sum[0], per_tangential));
  v.sin_phi = hn::Mul(sum[1], per_tangential);
  v.sin_h = hn::Mul(hn::Mul(tangential2, per_tangential), per_length);
  v.cos_h = hn::IfThenElse(hn::Eq(per_length, zero), one, hn::Mul(sum[2], per_length));
  // (wi - wo) / 2 along the tangents of growing theta_h and phi_h.
  const V ex = hn::Mul(half, difference[0]), ey = hn::Mul(half, difference[1]);
  const V ez = hn::Mul(half, difference[2]);
  const V radial = hn::MulAdd(ex, v.cos_phi, hn::Mul(ey, v.sin_phi));
  v.dx = hn::MulSub(radial, v.cos_h, hn::Mul(ez, v.sin_h));
  v.dy = hn::MulSub(ey, v.cos_phi, hn::Mul(ex, v.sin_phi));
  v.dz = hn::Mul(half, hn::Mul(length2, per_length));
  return v;
}

// Calls store(vectors, inputs of the first of them) for all pairs.
template <class Store>
HWY_INLINE void EncodeAll(const double* pairs, float* inputs, Store store) {
  const int lanes = static_cast<int>(hn::Lanes(F()));
  for (int n = 0; n < kBatch; n += lanes) store(ToHalfDiffVectors(pairs + 6 * n), inputs + n);
}

template <class... Vectors>
HWY_INLINE void StoreFeatures(float* to, Vectors... vectors) {
  for (const V& v : {vectors...}) {
    hn::StoreU(v, F(), to);
    to += kBatch;
  }
}

void CartesianInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    StoreFeatures(to, v.sin_h, hn::Zero(F()), v.cos_h, v.dx, v.dy, v.dz);
  });
}

// The vector (x, y), squared as a complex number: of d, s^2 (cos 2 phi_d, sin 2 phi_d) with
// s = sin theta_d.
struct DoubledPhi {
  HWY_INLINE DoubledPhi(V dx, V dy)
      : x(hn::MulSub(dx, dx, hn::Mul(dy, dy))), y(hn::Mul(hn::Add(dx, dx), dy)) {}
  V x, y;
};

void ReciprocalInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    const DoubledPhi doubled(v.dx, v.dy);
    const V per_s = InverseLength(hn::MulAdd(v.dx, v.dx, hn::Mul(v.dy, v.dy)));
    StoreFeatures(to, v.sin_h, hn::Zero(F()), v.cos_h, hn::Mul(doubled.x, per_s),
                  hn::Mul(doubled.y, per_s), v.dz);
  });
}

// theta_h on two scales: sqrt(2 theta_h / pi), log(theta_h + 0.001) / 3.
struct ScaledThetaH {
  explicit HWY_INLINE ScaledThetaH(const HalfDiffVectors& v) {
    constexpr float kTwoPerPi = 0.636619772f;
    const F d;
    const V theta_h = AngleOf(d, v.sin_h, v.cos_h);
    const V scaled = hn::Mul(theta_h, hn::Set(d, kTwoPerPi));
    root = hn::Mul(scaled, InverseLength(scaled));
    log = hn::Mul(hn::Log(d, hn::Add(theta_h, hn::Set(d, 1e-3f))), hn::Set(d, 1.0f / 3.0f));
  }
  V root, log;
};

void MultiscaleInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    const DoubledPhi doubled(v.dx, v.dy);
    const ScaledThetaH theta_h(v);
    StoreFeatures(to, v.sin_h, theta_h.root, theta_h.log, doubled.x, doubled.y, v.dz);
  });
}

// 4 u (1 - u), u the fraction of 90 root.
HWY_INLINE V RowBend(V root) {
  const F d;
  const V row = hn::Mul(root, hn::Set(d, 90.0f)), u = hn::Sub(row, hn::Floor(row));
  return hn::Mul(hn::Mul(hn::Set(d, 4.0f), u), hn::Sub(hn::Set(d, 1.0f), u));
}

void MerlInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    const DoubledPhi doubled(v.dx, v.dy);
    const ScaledThetaH theta_h(v);
    StoreFeatures(to, RowBend(theta_h.root), theta_h.root, theta_h.log, doubled.x, doubled.y, v.dz);
  });
}

void BilateralInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    const DoubledPhi doubled(v.dx, v.dy);
    const ScaledThetaH theta_h(v);
    StoreFeatures(to, RowBend(theta_h.root), theta_h.root, theta_h.log, doubled.x, v.sin_h, v.dz);
  });
}

void AnisotropicInputs(const double* pairs, float* inputs) {
  EncodeAll(pairs, inputs, [](const HalfDiffVectors& v, float* to) HWY_ATTR {
    // d turned by phi_h.
    const V tx = hn::MulSub(v.dx, v.cos_phi, hn::Mul(v.dy, v.sin_phi));
    const V ty = hn::MulAdd(v.dx, v.sin_phi, hn::Mul(v.dy, v.cos_phi));
    const DoubledPhi doubled(tx, ty);
    const ScaledThetaH theta_h(v);
    // root^(3/2)
    const V r = hn::Mul(hn::Mul(theta_h.root, theta_h.root), InverseLength(theta_h.root));
    StoreFeatures(to, hn::Mul(r, v.cos_phi), hn::Mul(r, v.sin_phi), theta_h.log, doubled.x,
                  doubled.y, v.dz);
  });
}

// expm1(z), clamped. The largest z is cut before it overflows.
HWY_INLINE V ReflectanceOf(V z, V largest) {
  const F d;
  const auto positive = hn::Gt(z, hn::Zero(d));  // not NaN
  const V f = FastExpm1(d, hn::Min(hn::IfThenElseZero(positive, z), hn::Set(d, 87.0f)));
  return hn::Min(f, largest);
}

void RgbReflectances(const float* z, float largest, double* f) {
  const F d;
  const hn::ScalableTag<double> dd;
  const hn::Rebind<float, decltype(dd)> half;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int half_lanes = static_cast<int>(hn::Lanes(dd));
  const V most = hn::Set(d, largest);
  HWY_ALIGN float rgb[3 * HWY_MAX_BYTES / sizeof(float)];
  for (int n = 0; n < kBatch; n += lanes, f += 3 * lanes) {
    hn::StoreInterleaved3(ReflectanceOf(hn::LoadU(d, z + n), most),
                          ReflectanceOf(hn::LoadU(d, z + kBatch + n), most),
                          ReflectanceOf(hn::LoadU(d, z + 2 * kBatch + n), most), d, rgb);
    for (int i = 0; i < 3 * lanes; i += half_lanes) {
      hn::StoreU(hn::PromoteTo(dd, hn::LoadU(half, rgb + i)), dd, f + i);
    }
  }
}

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

HWY_EXPORT(CartesianInputs);
HWY_EXPORT(ReciprocalInputs);
HWY_EXPORT(MultiscaleInputs);
HWY_EXPORT(MerlInputs);
HWY_EXPORT(BilateralInputs);
HWY_EXPORT(AnisotropicInputs);
HWY_EXPORT(RgbReflectances);

void EncodeCartesian(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(CartesianInputs)(pairs, inputs);
}

void EncodeReciprocal(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(ReciprocalInputs)(pairs, inputs);
}

void EncodeMultiscale(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(MultiscaleInputs)(pairs, inputs);
}

void EncodeMerl(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(MerlInputs)(pairs, inputs);
}

void EncodeBilateral(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(BilateralInputs)(pairs, inputs);
}

void EncodeAnisotropic(const double* pairs, float* inputs) {
  HWY_DYNAMIC_DISPATCH(AnisotropicInputs)(pairs, inputs);
}

void Reflectances(const float* z, float largest, double* f) {
  HWY_DYNAMIC_DISPATCH(RgbReflectances)(z, largest, f);
}

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
