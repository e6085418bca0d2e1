// process.h: runs other programs.
#pragma once

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

}  // namespace pbnbrdf
