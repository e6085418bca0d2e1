// kernels.h: what the kernels share. Kernels are the inner loops, for batches of kBatch samples:
// passes.h, products.h, losses.h. Each is compiled for several instruction sets; a call
// runs the best one that the processor has. T is float or double.
//
// Two layouts: by feature, x[i * kBatch + n], for passes through a network; by sample,
// x[n * stride + i], for sums over samples. Strides are in elements.
#pragma once

namespace pbnbrdf::kernels {

inline constexpr int kBatch = 128;

// Rows laid out by sample are padded with zeros to a multiple of this.
inline constexpr int kPad = 16;
constexpr int Padded(int size) { return (size + kPad - 1) / kPad * kPad; }

// The instruction set in use: "AVX3", "AVX2", ...
const char* InstructionSet();

}  // namespace pbnbrdf::kernels
