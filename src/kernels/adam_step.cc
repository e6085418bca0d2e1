// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/adam_step.h"

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "adam_step.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/highway.h>

#include "target-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

template <typename T>
HWY_INLINE void AdamStepOf(std::size_t count, const T* gradient, T rate, T beta1, T beta2,
                           T epsilon, T* mean, T* square, T* x) {
  const hn::ScalableTag<T> d;
  const auto b1 = hn::Set(d, beta1), b2 = hn::Set(d, beta2);
  // The moments of a dead unit would decay to subnormal numbers, which are slow.
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

// The exported names: one for each precision, as HWY_EXPORT wants plain functions.
#define PBNBRDF_KERNELS(T, Suffix)                                                                 \
  void AdamStep##Suffix(std::size_t count, const T* gradient, T rate, T beta1, T beta2, T epsilon, \
                        T* mean, T* square, T* x) {                                                \
    AdamStepOf(count, gradient, rate, beta1, beta2, epsilon, mean, square, x);                     \
  }

PBNBRDF_KERNELS(float, F)
PBNBRDF_KERNELS(double, D)
#undef PBNBRDF_KERNELS

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

#define PBNBRDF_DISPATCH(T, Suffix)                                                        \
  HWY_EXPORT(AdamStep##Suffix);                                                            \
  template <>                                                                              \
  void AdamStep(std::size_t count, const T* gradient, T rate, T beta1, T beta2, T epsilon, \
                T* mean, T* square, T* x) {                                                \
    HWY_DYNAMIC_DISPATCH(AdamStep##Suffix)                                                 \
    (count, gradient, rate, beta1, beta2, epsilon, mean, square, x);                       \
  }

PBNBRDF_DISPATCH(float, F)
PBNBRDF_DISPATCH(double, D)
#undef PBNBRDF_DISPATCH

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
