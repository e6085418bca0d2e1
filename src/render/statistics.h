// statistics.h: counts work in one line where it happens, in the manner of pbrt's STAT_COUNTER.
//
//   ThreadStatistics& stats = statistics.OfThisThread();
//   stats.Needed(&RenderWork::rays);
//   if (stats.Unneeded(&RenderWork::rays, SkipReason::kUnlit)) geometry.Occluded(ray, distance);
//   const ScopedTimer timer = stats.Time(&RenderWork::rays);
//   ...
//   RenderWork work = statistics.Sum();  // over all threads
#pragma once

#include "base/per_thread.h"
#include "base/timer.h"
#include "pbnbrdf/render/work.h"

namespace pbnbrdf {

class ThreadStatistics {
 public:
  using Kind = Work RenderWork::*;

  explicit ThreadStatistics(bool skip) : skip_(skip) {}

  // Counts work before it is done. Both return whether to do it: work that the image does not
  // depend on is done only if RenderOptions::skip is off.
  bool Needed(Kind kind, std::int64_t count = 1) {
    (work_.*kind).needed += count;
    (work_.*kind).done += count;
    return true;
  }
  [[nodiscard]] bool Unneeded(Kind kind, SkipReason reason) {
    ++(skip_ ? (work_.*kind).Skipped(reason) : (work_.*kind).done);
    return !skip_;
  }

  // Counts work that is left out even if RenderOptions::skip is off.
  void LeftOut(Kind kind, SkipReason reason, std::int64_t count) {
    (work_.*kind).Skipped(reason) += count;
  }

  // Adds the time until the timer's end to the kind's seconds.
  ScopedTimer Time(Kind kind) { return ScopedTimer(&(work_.*kind).seconds); }
  void SubtractSeconds(Kind kind, double seconds) { (work_.*kind).seconds -= seconds; }

  const RenderWork& work() const { return work_; }

 private:
  bool skip_;
  RenderWork work_;
};

class Statistics {
 public:
  // skip: RenderOptions::skip.
  explicit Statistics(bool skip) : threads_([skip] { return ThreadStatistics(skip); }) {}

  ThreadStatistics& OfThisThread() { return threads_.Local(); }

  // While no thread counts.
  RenderWork Sum() const {
    RenderWork sum;
    threads_.ForEach([&](const ThreadStatistics& thread) { sum += thread.work(); });
    return sum;
  }

 private:
  PerThread<ThreadStatistics> threads_;
};

}  // namespace pbnbrdf
