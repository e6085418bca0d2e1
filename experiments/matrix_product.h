// matrix_product.h: the machine's own rate of matrix products, to compare kernels with.
#pragma once

namespace pbnbrdf {

// Multiplies two float matrices of size x size once, with Eigen compiled for this very machine.
// Their entries are those of the last call's result, scaled, so that no call can be left out.
void MultiplyMatrices(int size);

// GFLOP/s of one core in MultiplyMatrices, measured when first called.
double MatrixProductRate();

}  // namespace pbnbrdf
