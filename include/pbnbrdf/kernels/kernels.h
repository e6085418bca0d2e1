// kernels.h: the inner loops, for batches of kBatch samples, in single and double precision. Each
// is compiled for several instruction sets, and the best one that the processor has is chosen when
// it is called. T is float or double.
//
// Two layouts: by feature, x[i * kBatch + n], for passes through a network; by sample,
// x[n * stride + i], for sums over samples. Strides are in elements.
#pragma once

#include <cstddef>

namespace pbnbrdf::kernels {

inline constexpr int kBatch = 128;

// Rows laid out by sample are padded with zeros to a multiple of this.
inline constexpr int kPad = 16;
constexpr int Padded(int size) { return (size + kPad - 1) / kPad * kPad; }

// y = W x + b. By feature: x in x kBatch, y out x kBatch. layer: [W | b], row-major, out x (in +
// 1).
template <typename T>
void Dense(const T* layer, int out, int in, const T* x, T* y);

// y = tanh(W x + b); errors as for Tanh.
template <typename T>
void DenseTanh(const T* layer, int out, int in, const T* x, T* y);

// x = W' y, the bias left out. Shapes as for Dense.
template <typename T>
void DenseTransposed(const T* layer, int out, int in, const T* y, T* x);

// In place; absolute error below 4e-7 (float; 2e-7 with AVX-512) or 1e-14 (double), odd, within
// [-1, 1], NaN for NaN.
// count: a multiple of kBatch.
template <typename T>
void Tanh(T* x, std::size_t count);

// In place, to a few units in the last place. count: a multiple of kBatch.
template <typename T>
void Exp(T* x, std::size_t count);

// x = max(0, x), in place, and its derivative: delta = 0 where y <= 0. count: a multiple of kBatch.
template <typename T>
void Relu(T* x, std::size_t count);
template <typename T>
void ReluSlopes(const T* y, std::size_t count, T* delta);

// The gradient with respect to z of, for each of kBatch samples,
//
//   log_weight * sum_c |log1p(f_c cos_i) - log1p(f^_c cos_i)|
//     + chromaticity_weight * |log1p(|f cos_i|^2) - log1p(|f^ cos_i|^2)|,   f^_c = expm1(z_c),
//
// eqs. 6 and 7; 0 where cos_i = 0. By feature: z, f and gradient 3 x kBatch, cos_i kBatch, in
// [0, 1].
template <typename T>
void AbsoluteLossGradient(const T* z, const T* cos_i, const T* f, T log_weight,
                          T chromaticity_weight, T* gradient);

// sums[c] += the sum over kBatch samples of weights[n] max(0, expm1(z[c][n])), c < 3: a part of a
// directional albedo. By feature: z 3 x kBatch.
template <typename T>
void AddReflectanceSums(const T* z, const T* weights, T* sums);

// A step of Adam without its corrections of bias, which are the caller's:
//   mean = beta1 mean + (1 - beta1) g,  square = beta2 square + (1 - beta2) g^2,
//   x -= rate mean / (sqrt(square) + epsilon).
// A mean or square below 1e-35 becomes 0. count: a multiple of kPad.
template <typename T>
void AdamStep(std::size_t count, const T* gradient, T rate, T beta1, T beta2, T epsilon, T* mean,
              T* square, T* x);

// out[n][(i, j)] = a[n][i] b[n][j], for n < kBatch. By sample:
//   a: stride Padded(na), kPad readable elements behind the last sample; likewise b with nb.
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

// The log term (eq. 6) and its derivative, in double precision: with u_c = expm1(z_c) cos_i,
//   residuals_c = targets_c - log1p(u_c),  slopes_c = d residuals_c / d z_c.
// By feature, 3 x kBatch; cos_i kBatch. Residuals aren't finite where z isn't or is above 706.
template <typename T>
void LogResiduals(const T* z, const double* targets, const double* cos_i, double* residuals,
                  double* slopes);

// The instruction set in use: "AVX3", "AVX2", ...
const char* InstructionSet();

}  // namespace pbnbrdf::kernels
