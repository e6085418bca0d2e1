// progress.h: long work shows how far it is, and Ctrl-C ends it early.
#pragma once

#include <string>

namespace pbnbrdf::cli {

// A line on a terminal that says how far the work is.
class ProgressLine {
 public:
  // Shows nothing if it is quiet, or if standard error isn't a terminal.
  explicit ProgressLine(bool quiet);
  ~ProgressLine() { Clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool IsShown() const { return shows_; }

  // In place of what it showed before.
  void Show(const std::string& text) const;
  void Clear() const { Show(""); }

 private:
  bool shows_;
};

// "1.2 s"
std::string SecondsText(double seconds);

// From now on the first Ctrl-C makes Interrupted() true; a second one ends the program.
void CatchInterrupt();

bool Interrupted();

}  // namespace pbnbrdf::cli
