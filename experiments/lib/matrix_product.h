// matrix_product.h: Eigen's matrix products, compiled for this machine. Kernels are compared with them.
#pragma once

namespace pbnbrdf {

// Multiplies two float matrices of size x size once.
// Each call multiplies the scaled result of the last one, so that the compiler can't drop any.
void MultiplyMatrices(int size);

// GFLOP/s of one core in MultiplyMatrices, measured when first called.
double MatrixProductRate();

// The lower triangle of sum (columns x columns) += J'J; j: rows x columns, row-major.
void AddProductWithItself(const float* j, int rows, int columns, float* sum);
void AddProductWithItself(const double* j, int rows, int columns, double* sum);

}  // namespace pbnbrdf
