#include "kernels/cholesky.h"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.h"
#include "kernels/products.h"

namespace pbnbrdf {
namespace {

constexpr int kBlock = 16;

}  // namespace

Cholesky::Cholesky(int size)
    : size_(size),
      stride_(kernels::Padded(size)),
      matrix_(static_cast<std::size_t>(size) * stride_),
      inverse_(kBlock * kBlock),
      panel_(static_cast<std::size_t>(size) * kBlock) {}

// Left-looking: the columns of a block get all contributions of the columns before them at once.
bool Cholesky::Factor() {
  for (int begin = 0; begin < size_; begin += kBlock) {
    const int end = std::min(begin + kBlock, size_), width = end - begin;
    kernels::AddRowProducts(-1.0, row(begin), size_ - begin, stride_, row(begin), width, stride_,
                            begin, row(begin) + begin, stride_);
    if (!FactorBlock(begin, end)) return false;
    // Below the block, X L_b' = A_b, that is X = A_b (L_b^-1)'.
    const int below = size_ - end;
    if (below == 0) break;
    for (int i = 0; i < below; ++i) {
      double* from = row(end + i) + begin;
      std::copy(from, from + width, panel_.data() + i * kBlock);
      std::fill(from, from + width, 0.0);
    }
    kernels::AddRowProducts(1.0, panel_.data(), below, kBlock, inverse_.data(), width, kBlock,
                            width, row(end) + begin, stride_);
  }
  return true;
}

// The diagonal block's factor L_b, and inverse_ = L_b^-1.
bool Cholesky::FactorBlock(int begin, int end) {
  for (int i = begin; i < end; ++i) {
    for (int j = begin; j <= i; ++j) {
      double sum = row(i)[j];
      for (int k = begin; k < j; ++k) sum -= row(i)[k] * row(j)[k];
      if (j < i) {
        row(i)[j] = sum / row(j)[j];
      } else if (sum > 0.0 && std::isfinite(sum)) {
        row(i)[i] = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  std::fill(inverse_.begin(), inverse_.end(), 0.0);
  for (int j = begin; j < end; ++j) {
    for (int i = j; i < end; ++i) {
      double sum = i == j ? 1.0 : 0.0;
      for (int k = j; k < i; ++k) sum -= row(i)[k] * inverse_[(k - begin) * kBlock + j - begin];
      inverse_[(i - begin) * kBlock + j - begin] = sum / row(i)[i];
    }
  }
  return true;
}

void Cholesky::SolveLower(double* b) const {
  for (int i = 0; i < size_; ++i) {
    kernels::AddRowProducts(-1.0, b, 1, size_, row(i), 1, stride_, i, b + i, 1);
    b[i] /= row(i)[i];
  }
}

void Cholesky::Solve(double* b) const {
  SolveLower(b);
  for (int i = size_ - 1; i >= 0; --i) {
    b[i] /= row(i)[i];
    for (int j = 0; j < i; ++j) b[j] -= b[i] * row(i)[j];
  }
}

}  // namespace pbnbrdf
