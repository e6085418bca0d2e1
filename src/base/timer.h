// timer.h: how long things take.
#pragma once

#include <chrono>

namespace pbnbrdf {

class Timer {
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

// Adds the time from its construction to its end to a sum of seconds.
class ScopedTimer {
 public:
  explicit ScopedTimer(double* seconds) : seconds_(seconds) {}
  ~ScopedTimer() { *seconds_ += timer_.Seconds(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double* seconds_;
  const Timer timer_;
};

}  // namespace pbnbrdf
