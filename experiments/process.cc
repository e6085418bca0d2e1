#include "process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "curves.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

constexpr int kMissing = 127;

struct Pipe {
  Pipe() {
    if (pipe2(ends, O_CLOEXEC) != 0) Fail("pipe: ", std::strerror(errno));
  }
  ~Pipe() {
    CloseWriter();
    close(ends[0]);
  }
  void CloseWriter() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }
  std::string ReadAll() {
    CloseWriter();
    std::string text;
    char buffer[4096];
    for (ssize_t n; (n = read(ends[0], buffer, sizeof(buffer))) != 0;) {
      if (n > 0) text.append(buffer, static_cast<std::size_t>(n));
      if (n < 0 && errno != EINTR) Fail("pipe: ", std::strerror(errno));
    }
    return text;
  }
  int ends[2];  // to read from, to write to
};

int WaitFor(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) Fail("waitpid: ", std::strerror(errno));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Null-terminated, as exec wants them; valid as long as `strings` are.
std::vector<char*> Pointers(const std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (const std::string& text : strings) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> Environment(const std::vector<std::string>& without) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    const std::string name(text.substr(0, text.find('=')));
    if (std::find(without.begin(), without.end(), name) == without.end()) {
      variables.emplace_back(text);
    }
  }
  return variables;
}

// A line "name:   1234 kB" of what the kernel says about this process.
std::size_t StatusBytes(const std::string& name) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(name + ":")) return std::stoul(line.substr(name.size() + 1)) * 1024;
  }
  Fail("/proc/self/status: has no ", name);
}

// Writes what `work` returns to the pipe and ends this process, leaving out the parent's clean-up.
[[noreturn]] void RunChild(const std::function<std::vector<double>()>& work, int to) {
  int status = 1;
  try {
    const std::vector<double> result = work();
    const auto size = static_cast<ssize_t>(result.size() * sizeof(double));
    if (write(to, result.data(), static_cast<std::size_t>(size)) == size) status = 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  _exit(status);
}

}  // namespace

ProgramResult RunProgram(const std::vector<std::string>& arguments,
                         const std::vector<std::string>& without) {
  Pipe pipe;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe.ends[1], STDOUT_FILENO);
  const std::vector<std::string> variables = Environment(without);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, arguments[0].c_str(), &actions, nullptr,
                                 Pointers(arguments).data(), Pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return {kMissing, ""};
  ProgramResult result;
  result.output = pipe.ReadAll();
  result.status = WaitFor(pid);
  return result;
}

std::vector<double> RunInChild(const std::function<std::vector<double>()>& work) {
  Pipe pipe;
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) Fail("fork: ", std::strerror(errno));
  if (pid == 0) RunChild(work, pipe.ends[1]);
  const std::string bytes = pipe.ReadAll();
  const int status = WaitFor(pid);
  if (status != 0) Fail("a measurement in a process of its own ended with status ", status);
  std::vector<double> result(bytes.size() / sizeof(double));
  std::memcpy(result.data(), bytes.data(), result.size() * sizeof(double));
  return result;
}

std::size_t ResidentMemory() { return StatusBytes("VmRSS"); }

std::size_t PeakMemory() { return StatusBytes("VmHWM"); }

double MedianSeconds(double least_seconds, const std::function<void()>& work) {
  std::vector<double> seconds;
  double total = 0.0;
  do {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    seconds.push_back(elapsed.count());
    total += elapsed.count();
  } while (total < least_seconds);
  return Median(seconds);
}

}  // namespace pbnbrdf
