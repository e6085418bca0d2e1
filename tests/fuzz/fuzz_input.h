// fuzz_input.h: what the fuzz targets share: an input as a file, and what counts as a finding.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

// The input as a file in memory, for readers that take a path.
class FuzzFile {
 public:
  FuzzFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("input", 0)) {
    if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~FuzzFile() { close(file_); }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  std::string path() const { return StrCat("/proc/self/fd/", file_); }

 private:
  int file_;
};

// Runs a function that may refuse its input by Error. Anything else that it throws is a finding, as is a message
// of several lines.
template <typename Function>
void MayRefuse(Function function) {
  try {
    function();
  } catch (const Error& error) {
    if (std::string(error.what()).find('\n') != std::string::npos) {
      std::fprintf(stderr, "a message of several lines: %s\n", error.what());
      std::abort();
    }
  }
}

// Ends the program, which is a finding, if the condition doesn't hold.
inline void Expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

}  // namespace pbnbrdf
