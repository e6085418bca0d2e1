#include "progress_line.h"

#include <unistd.h>

#include <cstdio>
#include <iomanip>
#include <sstream>

namespace pbnbrdf::cli {

ProgressLine::ProgressLine(bool quiet) : shows_(!quiet && isatty(STDERR_FILENO)) {}

void ProgressLine::Show(const std::string& text) const {
  if (shows_) std::fprintf(stderr, "\r\033[K%s", text.c_str());
}

std::string SecondsText(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << seconds << " s";
  return text.str();
}

}  // namespace pbnbrdf::cli
