#include "progress.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace pbnbrdf::cli {
namespace {

std::atomic<bool> interrupted = false;

void OnInterrupt(int) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

void CatchInterrupt() { std::signal(SIGINT, OnInterrupt); }

bool Interrupted() { return interrupted; }

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
