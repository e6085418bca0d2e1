// disabled_targets.h: the instruction sets for which no kernels are compiled. To be included before
// Highway.
#pragma once

// Vectors are kept in arrays, which those of unknown length can't be; the others are dispensable.
#define HWY_DISABLED_TARGETS \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)
