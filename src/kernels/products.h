// products.h: the products and sums of products that gradients and normal equations are made of.
// Layouts and T: kernels.h.
#pragma once

#include "kernels/kernels.h"

namespace pbnbrdf::kernels {

// out[n][(i, j)] = a[n][i] b[n][j], for n < kBatch. By sample:
//   a: stride Padded(na), kPad readable elements after the last sample; likewise b with nb.
//   out: pairs (i, j) in order, j fastest; with `symmetric` (a == b) those with j >= i only. Sample
//      stride out_stride, at least kPad more than there are pairs: kPad zeros follow them.
template <typename T>
void PairProducts(const T* a, int na, const T* b, int nb, bool symmetric, T* out, int out_stride);

// out[(i, j)][n] = sum over r < rows of a[r][i][n] b[r][j][n]. By feature: a rows x na x kBatch, b
// rows x nb x kBatch, out pairs x kBatch with the pairs of PairProducts.
template <typename T>
void SummedPairProducts(const T* a, int na, const T* b, int nb, int rows, bool symmetric, T* out);

// c[i][j] += sum over n < kBatch of x[i][n] y[n][j]: x by feature, p x kBatch; y by sample with q
// columns, its stride at least Padded(q); c p x Padded(q) doubles. Sums of kBatch terms are in
// precision T.
template <typename T>
void AddProduct(const T* x, int p, const T* y, int q, int y_stride, double* c);

// c[i][j] += alpha times the sum over k < size of x[i][k] y[j][k], for i < rows_x and j < rows_y.
// Row-major, any sizes.
template <typename T>
void AddRowProducts(T alpha, const T* x, int rows_x, int x_stride, const T* y, int rows_y,
                    int y_stride, int size, T* c, int c_stride);

}  // namespace pbnbrdf::kernels
