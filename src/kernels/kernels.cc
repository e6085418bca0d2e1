// Written with Highway: this file is compiled once for each instruction set (foreach_target.h).
#include "kernels/kernels.h"

#include "disabled_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels.cc"
#include <hwy/foreach_target.h>
// clang-format: keep the order
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace pbnbrdf::kernels::HWY_NAMESPACE {
namespace {

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace
}  // namespace pbnbrdf::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pbnbrdf::kernels {

HWY_EXPORT(TargetName);
const char* InstructionSet() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace pbnbrdf::kernels
#endif  // HWY_ONCE
