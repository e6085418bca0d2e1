// for_each.h: many pieces of work, some of them at a time.
#pragma once

#include <cstddef>
#include <functional>

namespace pbnbrdf {

// Calls `work` with each of 0 ... count - 1, `at_a_time` of them at once in threads of their own. The
// first Error that one throws ends all, and is thrown when they have ended.
void ForEach(std::size_t count, int at_a_time, const std::function<void(std::size_t)>& work);

}  // namespace pbnbrdf
