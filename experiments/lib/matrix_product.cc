#include "matrix_product.h"

// This file is compiled for other instructions than the rest of the program, which uses Eigen's inline
// functions too. Another namespace keeps the linker from mixing them up.
#define Eigen NativeEigen
#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <vector>

namespace pbnbrdf {
namespace {

template <typename T>
void AddProduct(const T* j, int rows, int columns, T* sum) {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> jacobian(j, rows, columns);
  Eigen::Map<Matrix>(sum, columns, columns)
      .template selfadjointView<Eigen::Lower>()
      .rankUpdate(jacobian.transpose());
}

}  // namespace

void MultiplyMatrices(int size) {
  using Matrix = Eigen::MatrixXf;
  static Matrix a, b, c;
  if (a.rows() != size) {
    a = Matrix::Random(size, size);
    b = Matrix::Random(size, size);
    c.setZero(size, size);
  }
  c.noalias() = a * b;
  b(0, 0) = 0.5f * c(0, 0) / static_cast<float>(size);
}

double MatrixProductRate() {
  static const double rate = [] {
    constexpr int kSize = 512, kRuns = 40;
    std::vector<double> seconds;
    for (int run = 0; run < kRuns; ++run) {
      const auto start = std::chrono::steady_clock::now();
      MultiplyMatrices(kSize);
      const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
      seconds.push_back(elapsed.count());
    }
    std::nth_element(seconds.begin(), seconds.begin() + kRuns / 2, seconds.end());
    return 2e-9 * kSize * kSize * kSize / seconds[kRuns / 2];
  }();
  return rate;
}

void AddProductWithItself(const float* j, int rows, int columns, float* sum) {
  AddProduct(j, rows, columns, sum);
}

void AddProductWithItself(const double* j, int rows, int columns, double* sum) {
  AddProduct(j, rows, columns, sum);
}

}  // namespace pbnbrdf
