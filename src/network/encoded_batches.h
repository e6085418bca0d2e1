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
    inputs_.reserve((pairs + kernels::kBatch - 1) / kernels::kBatch * kBatchSize);
  }

  void Add(const std::array<double, kEncodedSize>& input) {
    T* place = PlaceOfNext();
    for (std::size_t i = 0; i < kEncodedSize; ++i) {
      place[i * kernels::kBatch] = static_cast<T>(input[i]);
    }
  }

  // Adds the pairs from..to of others, converted.
  template <typename U>
  void Add(const EncodedBatches<U>& others, std::size_t from, std::size_t to) {
    Reserve(to);
    for (std::size_t n = from; n < to; ++n) {
      const U* other = others.batch(n / kernels::kBatch) + n % kernels::kBatch;
      T* place = PlaceOfNext();
      for (std::size_t i = 0; i < kEncodedSize; ++i) {
        place[i * kernels::kBatch] = static_cast<T>(other[i * kernels::kBatch]);
      }
    }
  }

  std::size_t size() const { return size_; }
  std::size_t num_batches() const { return (size_ + kernels::kBatch - 1) / kernels::kBatch; }

  // The inputs of a batch, kEncodedSize x kBatch; those behind the last pair are zeros.
  const T* batch(std::size_t b) const { return inputs_.data() + b * kBatchSize; }

  // How many pairs batch b holds.
  int batch_size(std::size_t b) const {
    return static_cast<int>(std::min<std::size_t>(kernels::kBatch, size_ - b * kernels::kBatch));
  }

 private:
  static constexpr std::size_t kBatchSize = std::size_t{kEncodedSize} * kernels::kBatch;

  T* PlaceOfNext() {
    const std::size_t place = size_++ % kernels::kBatch;
    if (place == 0) inputs_.resize(inputs_.size() + kBatchSize);
    return inputs_.data() + inputs_.size() - kBatchSize + place;
  }

  std::size_t size_ = 0;
  AlignedVector<T> inputs_;
};

}  // namespace pbnbrdf
