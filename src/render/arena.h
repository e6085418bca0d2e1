// arena.h: how many threads work on an image.
#pragma once

#include <tbb/task_arena.h>

#include <algorithm>

namespace pbnbrdf {

// For tbb::task_arena. threads: as an option has it; 0: as many as there are.
inline int ArenaThreads(int threads) {
  const int most = tbb::this_task_arena::max_concurrency();
  return threads > 0 ? std::min(threads, most) : most;
}

}  // namespace pbnbrdf
