// instruction_sets.h: runs a test's kernels on each instruction set that the processor has.
#pragma once

#include <hwy/targets.h>

#include <cstdint>

#include "kernels/kernels.h"

namespace pbnbrdf {

// Calls test(name) with the kernels of one instruction set after the other.
template <typename Test>
void ForEachInstructionSet(Test test) {
  for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    hwy::SetSupportedTargetsForTest(target);
    test(kernels::InstructionSet());
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace pbnbrdf
