#include "for_each.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace pbnbrdf {

void ForEach(std::size_t count, int at_a_time, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr first_error;
  const auto run = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        work(k);
      } catch (...) {
        next = count;
        const std::scoped_lock lock(mutex);
        if (!first_error) first_error = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int k = 0; k < at_a_time; ++k) threads.emplace_back(run);
  }
  if (first_error) std::rethrow_exception(first_error);
}

}  // namespace pbnbrdf
