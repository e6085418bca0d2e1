// cholesky.h: the Cholesky factorisation of a symmetric positive definite matrix, with the kernels'
// instruction set: several times as fast as one compiled for any x86-64.
#pragma once

#include "base/aligned_vector.h"

namespace pbnbrdf {

// Holds the lower triangle L of A = L L', row-major.
class Cholesky {
 public:
  explicit Cholesky(int size);

  int size() const { return size_; }
  int stride() const { return stride_; }

  // To be filled with A before Factor: element (i, j) at row(i)[j], j <= i.
  double* row(int i) { return matrix_.data() + static_cast<std::size_t>(i) * stride_; }
  const double* row(int i) const { return matrix_.data() + static_cast<std::size_t>(i) * stride_; }

  // False, with the matrix spoiled, unless A is positive definite to rounding.
  bool Factor();

  // After Factor. In place: b becomes L^-1 b, or A^-1 b; size() numbers.
  void SolveLower(double* b) const;
  void Solve(double* b) const;

 private:
  bool FactorBlock(int begin, int end);

  int size_, stride_;
  AlignedVector<double> matrix_;
  AlignedVector<double> inverse_, panel_;  // of the diagonal block; a row of blocks
};

}  // namespace pbnbrdf
