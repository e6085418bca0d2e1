// Loops over threads: each call happens once, exceptions come back, and a thread keeps its value.
#include "base/parallel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/per_thread.h"

namespace pbnbrdf {
namespace {

TEST(Parallel, EachCallHappensOnce) {
  for (std::size_t count : {0, 1, 2, 3, 1000}) {
    std::vector<int> calls(count);
    ParallelFor(count, [&](std::size_t k) { ++calls[k]; });
    EXPECT_THAT(calls, testing::Each(1));
  }
}

TEST(Parallel, AnExceptionIsThrownAgainOnceAllHaveEnded) {
  std::atomic<int> running = 0;
  const auto run = [&](std::size_t k) {
    ++running;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --running;
    if (k % 3 == 1) throw std::runtime_error("one that failed");
  };
  EXPECT_THROW(ParallelFor(20, run), std::runtime_error);
  EXPECT_EQ(running, 0);
}

TEST(Parallel, OneThreadIsTheCallersOwn) {
  WithThreads(1, [] {
    const auto caller = std::this_thread::get_id();
    ParallelFor(100, [&](std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
  });
}

TEST(Parallel, LoopsWithinLoopsEnd) {
  std::atomic<int> calls = 0;
  ParallelFor(8, [&](std::size_t) {
    Isolated([&] { ParallelFor(8, [&](std::size_t) { ++calls; }); });
    WithThreads(2, [&] { ParallelFor(8, [&](std::size_t) { ++calls; }); });
  });
  EXPECT_EQ(calls, 128);
}

TEST(PerThread, EachThreadKeepsItsOwn) {
  std::atomic<int> made = 0;
  PerThread<int> counts([&] {
    ++made;
    return 0;
  });
  ParallelFor(1000, [&](std::size_t) { ++counts.Local(); });
  int sum = 0, values = 0;
  counts.ForEach([&](int count) { sum += count, ++values; });
  EXPECT_EQ(sum, 1000);
  EXPECT_EQ(values, made);
}

}  // namespace
}  // namespace pbnbrdf
