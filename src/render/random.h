// random.h: the random numbers of a path; they do not depend on the thread that traces it.
#pragma once

#include <array>
#include <cstdint>

namespace pbnbrdf {

// splitmix64 (Steele, Lea, Flood 2014), started from the seed, the pixel and the sample.
class Random {
 public:
  Random() = default;
  Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
      : state_(Mix(Mix(Mix(seed) + pixel) + sample)) {}

  // Uniform in [0, 1).
  double Next() {
    state_ += kStep;
    return static_cast<double>(Mix(state_) >> 11) * 0x1p-53;
  }
  std::array<double, 2> Pair() {
    const double first = Next();
    return {first, Next()};
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;

  static std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_ = 0;
};

}  // namespace pbnbrdf
