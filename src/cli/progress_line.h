// progress_line.h: a line on a terminal that says how far the work is.
#pragma once

#include <string>

namespace pbnbrdf::cli {

class ProgressLine {
 public:
  // Shows nothing if it is quiet, or if standard error isn't a terminal.
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { Clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // In place of what it showed before.
  void Show(const std::string& text) const;
  void Clear() const { Show(""); }

 private:
  bool shows_;
};

// "1.2 s"
std::string SecondsText(double seconds);

}  // namespace pbnbrdf::cli
