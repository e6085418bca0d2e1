// cpu_timer.h: the processor time of this process, all threads together, which other programs on the machine
// don't stretch.
#pragma once

#include <ctime>

namespace pbnbrdf {

class CpuTimer {
 public:
  double Seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace pbnbrdf
