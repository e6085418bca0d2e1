#include "base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace pbnbrdf {

void ParallelFor(std::size_t count, const std::function<void(std::size_t)>& run) {
  tbb::parallel_for(std::size_t{0}, count, run);
}

void WithThreads(int threads, const std::function<void()>& run) {
  const int all = tbb::this_task_arena::max_concurrency();
  tbb::task_arena arena(threads > 0 ? std::min(threads, all) : all);
  arena.execute(run);
}

void Isolated(const std::function<void()>& run) { tbb::this_task_arena::isolate(run); }

}  // namespace pbnbrdf
