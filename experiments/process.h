// process.h: other programs, and the time and memory of this one.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace pbnbrdf {

struct ProgramResult {
  int status = 0;      // as a shell says it: 127 if the program is missing, 128 + signal
  std::string output;  // what it wrote to standard output
};

// Waits for it to end. arguments: the program, sought in PATH, and its arguments. without:
// variables taken from its environment.
ProgramResult RunProgram(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& without = {});

// Runs `work` in a process of its own, whose memory is then its own too, and returns what it
// returns. To be called before this process starts threads. Throws Error if that process fails.
std::vector<double> RunInChild(const std::function<std::vector<double>()>& work);

// Of this process, bytes.
std::size_t ResidentMemory();
std::size_t PeakMemory();

// The median of as many runs as fit in `least_seconds`, at least one.
double MedianSeconds(double least_seconds, const std::function<void()>& work);

}  // namespace pbnbrdf
