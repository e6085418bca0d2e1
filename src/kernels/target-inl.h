// target-inl.h: properties of the instruction set that kernels are compiled for. Included once for
// each instruction set, after foreach_target.h.

// Highway's own form of #pragma once for such files.
#if defined(PBNBRDF_TARGET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PBNBRDF_TARGET_INL_H
#undef PBNBRDF_TARGET_INL_H
#else
#define PBNBRDF_TARGET_INL_H
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// 32 vector registers rather than 16.
inline constexpr bool kManyRegisters = HWY_MAX_BYTES >= 64 || HWY_ARCH_ARM_A64;

}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PBNBRDF_TARGET_INL_H
