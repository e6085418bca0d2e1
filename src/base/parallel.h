// parallel.h: work shared among threads. It is TBB's, which no other module calls.
#pragma once

#include <cstddef>
#include <functional>

namespace pbnbrdf {

// Calls run(k) for each k < count, in any order and on as many threads as there are. The first exception is
// thrown again once all calls that have begun have ended. Each call should take some microseconds at least.
void ParallelFor(std::size_t count, const std::function<void(std::size_t)>& run);

// Calls run(), in which ParallelFor uses at most `threads` threads; all there are if threads is 0.
void WithThreads(int threads, const std::function<void()>& run);

// Calls run(), while whose ParallelFor waits this thread takes up nothing from outside of it. For work under a lock.
void Isolated(const std::function<void()>& run);

}  // namespace pbnbrdf
