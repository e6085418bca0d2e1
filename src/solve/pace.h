// pace.h: how a fit's time and progress are watched.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace pbnbrdf {

// A clock that can be stopped.
class Stopwatch {
 public:
  double Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  // Runs what isn't to be counted.
  template <typename Function>
  auto Exclude(Function function) {
    const Clock::time_point before = Clock::now();
    auto result = function();
    start_ += Clock::now() - before;
    return result;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

// Whether a number that is watched has all but ceased to fall.
class Slowdown {
 public:
  // Slow: its least value has fallen by less than a part of `fall` over `iterations`.
  Slowdown(std::size_t iterations, double fall) : iterations_(iterations), fall_(fall) {}

  bool Observe(double value) {
    least_.push_back(least_.empty() ? value : std::min(value, least_.back()));
    if (least_.size() <= iterations_) return false;
    return least_.back() > (1.0 - fall_) * least_[least_.size() - 1 - iterations_];
  }

 private:
  std::size_t iterations_;
  double fall_;
  std::vector<double> least_;  // so far, at each iteration
};

}  // namespace pbnbrdf
