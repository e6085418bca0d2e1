#include "experiment.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <thread>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

DEFINE_string(out_dir, ".", "folder to write to");

namespace pbnbrdf {
namespace {

constexpr double kMostCount = 1e9;

// The flags of this folder's files; the libraries have their own.
void PrintHelp(const std::string& usage) {
  std::cout << usage << "\nFlags:\n";
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (flag.filename.find("experiments/") == std::string::npos) continue;
    std::cout << "  --" << flag.name << "  " << flag.description;
    if (!flag.default_value.empty()) std::cout << " [" << flag.default_value << "]";
    std::cout << "\n";
  }
}

}  // namespace

int RunExperiment(int argc, char** argv, const std::string& usage,
                  void (*run)(const std::vector<std::string>& arguments)) {
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--help") {
      PrintHelp(usage);
      return 0;
    }
  }
  gflags::ParseCommandLineFlags(&argc, &argv, /*remove_flags=*/true);
  try {
    std::filesystem::create_directories(FLAGS_out_dir);
    run({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", gflags::ProgramInvocationShortName(), error.what());
    return 1;
  }
}

std::string OutputPath(const std::string& file) { return FLAGS_out_dir + "/" + file; }

void WriteReport(const std::string& name, const std::string& markdown) {
  std::cout << markdown << std::flush;
  WriteFile(OutputPath(name + ".md"), markdown);
}

void WriteFigure(const std::string& name, const Figure& figure) {
  const std::string problem = DrawFigure(figure, OutputPath(name + ".svg"));
  if (!problem.empty()) std::fprintf(stderr, "%s\n", problem.c_str());
}

std::vector<std::size_t> ParseCounts(const std::string& flag, const std::string& text) {
  std::vector<std::size_t> counts;
  for (const std::string& part : Split(text, ',')) {
    const double count = ParseNumber(flag, part);
    if (!(count >= 1.0 && count <= kMostCount)) {
      Fail(flag, ": ", part, "; must be 1 to ", kMostCount);
    }
    counts.push_back(static_cast<std::size_t>(count));
  }
  return counts;
}

std::vector<std::vector<int>> ParseNetworks(const std::string& flag, const std::string& text) {
  std::vector<std::vector<int>> networks;
  for (const std::string& network : Split(text, ' ')) {
    if (network.empty()) continue;
    const std::vector<std::size_t> sizes = ParseCounts(flag, network);
    networks.emplace_back(sizes.begin(), sizes.end());
  }
  if (networks.empty()) Fail(flag, ": names no network, as 21,21 does");
  return networks;
}

void ForEach(std::size_t count, int at_a_time, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr first_error;
  const auto run = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        work(k);
      } catch (...) {
        next = count;
        const std::scoped_lock lock(mutex);
        if (!first_error) first_error = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int k = 0; k < at_a_time; ++k) threads.emplace_back(run);
  }
  if (first_error) std::rethrow_exception(first_error);
}

std::string HiddenName(const std::vector<int>& hidden) {
  std::string name;
  for (int size : hidden) name += StrCat(name.empty() ? "" : "-", size);
  return name;
}

}  // namespace pbnbrdf
