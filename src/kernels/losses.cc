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

#include "float_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

void VectorLogResiduals(const double* z, const double* targets, const double* cos_i,
                        double* residuals, double* slopes) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const V one = hn::Set(d, 1.0);
  for (int k = 0; k < 3 * kBatch; k += static_cast<int>(hn::Lanes(d))) {
    const V x = hn::LoadU(d, z + k);
    const V cos = hn::LoadU(d, cos_i + k % kBatch);
    const V f = hn::Expm1(d, x);
    const V u = hn::Mul(f, cos);
    // Expm1 and Log1p are undefined where x overflows or isn't finite.
    const V overflow = hn::IfThenElseZero(hn::Gt(x, hn::Set(d, 706.0)), hn::Set(d, kInfinity));
    const V log = hn::Add(hn::MulAdd(hn::Zero(d), x, overflow), hn::Log1p(d, u));
    const V slope = hn::Div(hn::Mul(hn::Add(f, one), cos), hn::Add(u, one));
    // At normal incidence log1p(expm1(x)) is x. Computed, it is the logarithm of 0 for x < -37.
    const auto normal = hn::Eq(cos, one);
    const V exact_log = hn::IfThenElse(normal, x, log);
    hn::StoreU(hn::Sub(hn::LoadU(d, targets + k), exact_log), d, residuals + k);
    hn::StoreU(hn::Neg(hn::IfThenElse(normal, one, slope)), d, slopes + k);
  }
}

using F = hn::ScalableTag<float>;
using V = hn::Vec<F>;

// 1, 0 or -1.
HWY_INLINE V Sign(V x) {
  const F d;
  const V magnitude = hn::IfThenZeroElse(hn::Eq(x, hn::Zero(d)), hn::Set(d, 1.0f));
  return hn::CopySign(magnitude, x);
}

// exp(z), z at most 40. No reflectance is larger, gradients have reached their limits there, and f^ doesn't
// overflow yet.
HWY_INLINE V GrownAt(const float* z) {
  const F d;
  return hn::Exp(d, AtMost(d, 40.0f, hn::LoadU(d, z)));
}

// The sign of log1p(a) - log1p(b) is that of a - b: the gradients below need no logarithm.

void VectorLogGradient(const float* z, const float* cos_i, const float* f, float weight,
                       float* gradient) {
  const F d;
  const V one = hn::Set(d, 1.0f), min_lit = hn::Set(d, 1e-30f);
  for (int k = 0; k < 3 * kBatch; k += static_cast<int>(hn::Lanes(d))) {
    const V cos = hn::LoadU(d, cos_i + k % kBatch), grown = GrownAt(z + k);
    const V fit = hn::Sub(grown, one);
    const V up = hn::Mul(hn::Set(d, weight), Sign(hn::Sub(fit, hn::LoadU(d, f + k))));
    // 1 + f^ cos_i = (1 - cos_i) + cos_i exp(z), without the cancellation.
    const V lit = hn::Max(hn::MulAdd(cos, grown, hn::Sub(one, cos)), min_lit);
    const V slope = hn::Mul(grown, hn::Div(hn::Mul(up, cos), lit));
    hn::StoreU(hn::Add(hn::LoadU(d, gradient + k), slope), d, gradient + k);
  }
}

void VectorChromaticityGradient(const float* z, const float* cos_i, const float* f, float weight,
                                float* gradient) {
  const F d;
  const V one = hn::Set(d, 1.0f);
  for (int n = 0; n < kBatch; n += static_cast<int>(hn::Lanes(d))) {
    const V cos = hn::LoadU(d, cos_i + n), cos2 = hn::Mul(cos, cos);
    V grown[3], fit[3], norm = hn::Zero(d), norm_fit = hn::Zero(d);
    for (int c = 0; c < 3; ++c) {
      grown[c] = GrownAt(z + c * kBatch + n);
      fit[c] = hn::Sub(grown[c], one);
      const V from = hn::LoadU(d, f + c * kBatch + n);
      norm = hn::MulAdd(from, from, norm);
      norm_fit = hn::MulAdd(fit[c], fit[c], norm_fit);
    }
    const V side = Sign(hn::Sub(norm_fit, norm));
    const V chroma = hn::Div(hn::Mul(hn::Set(d, 2.0f * weight), hn::Mul(side, cos2)),
                             hn::MulAdd(cos2, norm_fit, one));
    for (int c = 0; c < 3; ++c) {
      float* to = gradient + c * kBatch + n;
      hn::StoreU(hn::MulAdd(grown[c], hn::Mul(chroma, fit[c]), hn::LoadU(d, to)), d, to);
    }
  }
}

void VectorReflectanceSums(const float* z, const float* weights, float* sums) {
  const F d;
  for (int c = 0; c < 3; ++c) {
    V sum = hn::Zero(d);
    for (int n = 0; n < kBatch; n += static_cast<int>(hn::Lanes(d))) {
      const V grown = hn::Exp(d, AtLeast(d, 0.0f, hn::LoadU(d, z + c * kBatch + n)));
      sum = hn::MulAdd(hn::LoadU(d, weights + n), hn::Sub(grown, hn::Set(d, 1.0f)), sum);
    }
    sums[c] += hn::GetLane(hn::SumOfLanes(d, sum));
  }
}

void VectorAdamStep(std::size_t count, const float* gradient, float rate, float beta1, float beta2,
                    float epsilon, float* mean, float* square, float* x) {
  const F d;
  const auto b1 = hn::Set(d, beta1), b2 = hn::Set(d, beta2);
  // The moments of a dead unit would decay to subnormal numbers, which are slow.
  const auto without_tiny = [&](auto value) {
    return hn::IfThenElseZero(hn::Gt(hn::Abs(value), hn::Set(d, 1e-35f)), value);
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

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

HWY_EXPORT(VectorLogResiduals);
HWY_EXPORT(VectorLogGradient);
HWY_EXPORT(VectorChromaticityGradient);
HWY_EXPORT(VectorReflectanceSums);
HWY_EXPORT(VectorAdamStep);

void LogResiduals(const double* z, const double* targets, const double* cos_i, double* residuals,
                  double* slopes) {
  HWY_DYNAMIC_DISPATCH(VectorLogResiduals)(z, targets, cos_i, residuals, slopes);
}

void AddAbsoluteLogGradient(const float* z, const float* cos_i, const float* f, float weight,
                            float* gradient) {
  HWY_DYNAMIC_DISPATCH(VectorLogGradient)(z, cos_i, f, weight, gradient);
}

void AddAbsoluteChromaticityGradient(const float* z, const float* cos_i, const float* f,
                                     float weight, float* gradient) {
  HWY_DYNAMIC_DISPATCH(VectorChromaticityGradient)(z, cos_i, f, weight, gradient);
}

void AddReflectanceSums(const float* z, const float* weights, float* sums) {
  HWY_DYNAMIC_DISPATCH(VectorReflectanceSums)(z, weights, sums);
}

void AdamStep(std::size_t count, const float* gradient, float rate, float beta1, float beta2,
              float epsilon, float* mean, float* square, float* x) {
  HWY_DYNAMIC_DISPATCH(VectorAdamStep)
  (count, gradient, rate, beta1, beta2, epsilon, mean, square, x);
}

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
