// arena.h: how many threads render.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

namespace pbnbrdf {

// The concurrency of a tbb::task_arena. threads: an option, 0 for as many as there are.
inline int ArenaThreads(int threads) {
  const int max = tbb::this_task_arena::max_concurrency();
  return threads > 0 ? std::min(threads, max) : max;
}

}  // namespace pbnbrdf
