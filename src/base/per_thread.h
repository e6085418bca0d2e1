// per_thread.h: a value for each thread that works at something.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace pbnbrdf {

template <typename T>
class PerThread {
 public:
  // make(): a thread's value before its first use.
  explicit PerThread(std::function<T()> make) : make_(std::move(make)) {}

  // This thread's value, which no other thread gets. It takes a lock: to be asked for once per tile, not per
  // ray.
  T& Local() {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<T>& value = values_[std::this_thread::get_id()];
    if (!value) value.reset(new T(make_()));
    return *value;
  }

  // Calls use(value) for all values, while no thread works.
  template <typename Use>
  void ForEach(Use use) const {
    for (const auto& [thread, value] : values_) use(*value);
  }

 private:
  std::function<T()> make_;
  std::mutex mutex_;
  std::map<std::thread::id, std::unique_ptr<T>> values_;
};

}  // namespace pbnbrdf
