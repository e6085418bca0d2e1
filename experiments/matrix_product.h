// matrix_product.h: Eigen's matrix products, compiled for this very machine: what kernels are
// compared with.
#pragma once

namespace pbnbrdf {

// Multiplies two float matrices of size x size once.
// Their entries are those of the last call's result, scaled, so that no call can be left out.
void MultiplyMatrices(int size);

// GFLOP/s of one core in MultiplyMatrices, measured when first called.
double MatrixProductRate();

// The lower triangle of sum (columns x columns) += J'J; j: rows x columns, row-major.
void AddProductWithItself(const float* j, int rows, int columns, float* sum);
void AddProductWithItself(const double* j, int rows, int columns, double* sum);

}  // namespace pbnbrdf
