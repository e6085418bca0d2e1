// encoded_batches.h: direction pairs, encoded once, in batches for the kernels.
#pragma once

#include <algorithm>
#include <array>

#include "base/aligned_vector.h"
#include "kernels/kernels.h"
#include "pbnbrdf/network/encoding.h"

namespace pbnbrdf {

// Encoded direction pairs, kBatch at a time, by feature (kernels.h). T is float or double.
template <typename T>
class EncodedBatches {
 public:
  void Reserve(std::size_t pairs) {
    inputs_.reserve((pairs + kernels::kBatch - 1) / kernels::kBatch * kEncodedSize *
                    kernels::kBatch);
  }

  void Add(const std::array<double, kEncodedSize>& input) {
    const std::size_t lane = size_ % kernels::kBatch;
    if (lane == 0) inputs_.resize(inputs_.size() + kEncodedSize * kernels::kBatch);
    T* batch = inputs_.data() + inputs_.size() - kEncodedSize * kernels::kBatch;
    for (int i = 0; i < kEncodedSize; ++i) {
      batch[i * kernels::kBatch + lane] = static_cast<T>(input[i]);
    }
    ++size_;
  }

  std::size_t size() const { return size_; }
  std::size_t num_batches() const { return (size_ + kernels::kBatch - 1) / kernels::kBatch; }

  // The inputs of a batch, kEncodedSize x kBatch; those behind the last pair are zeros.
  const T* batch(std::size_t b) const {
    return inputs_.data() + b * kEncodedSize * kernels::kBatch;
  }

  // How many pairs batch b holds.
  int batch_size(std::size_t b) const {
    return static_cast<int>(std::min<std::size_t>(kernels::kBatch, size_ - b * kernels::kBatch));
  }

 private:
  std::size_t size_ = 0;
  AlignedVector<T> inputs_;
};

}  // namespace pbnbrdf
