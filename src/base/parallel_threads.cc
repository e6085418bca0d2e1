// The interface of parallel.h on std::thread, in place of parallel.cc where the thread sanitizer watches: it can't
// see what TBB's library, which is built without it, does in order.
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/parallel.h"

namespace pbnbrdf {
namespace {

// More threads than most machines that test have cores, so that they meet in more ways.
constexpr int kThreads = 4;

thread_local int threads_of_this = kThreads;  // that a ParallelFor of this thread uses

// Sets threads_of_this for as long as it lives.
class ScopedThreads {
 public:
  explicit ScopedThreads(int threads) : before_(threads_of_this) { threads_of_this = threads; }
  ~ScopedThreads() { threads_of_this = before_; }
  ScopedThreads(const ScopedThreads&) = delete;
  ScopedThreads& operator=(const ScopedThreads&) = delete;

 private:
  int before_;
};

}  // namespace

void ParallelFor(std::size_t count, const std::function<void(std::size_t)>& run) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    const ScopedThreads alone(1);  // a loop within this one is run by this thread
    try {
      for (std::size_t k = next++; k < count; k = next++) run(k);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < std::min(count, std::size_t(threads_of_this)); ++t) {
    others.emplace_back(work);
  }
  work();
  for (std::thread& other : others) other.join();
  if (error) std::rethrow_exception(error);
}

void WithThreads(int threads, const std::function<void()>& run) {
  const int count = threads > 0 ? threads : kThreads;
  // Embree, which works by TBB, keeps to as many; TBB complains of more than the machine has.
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  tbb::task_arena(std::min(count, cores)).execute([&] {
    const ScopedThreads scope(count);
    run();
  });
}

void Isolated(const std::function<void()>& run) { run(); }

}  // namespace pbnbrdf
