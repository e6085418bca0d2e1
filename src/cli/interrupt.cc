#include "interrupt.h"

#include <atomic>
#include <csignal>

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

}  // namespace pbnbrdf::cli
