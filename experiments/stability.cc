// stability.cc: thousands of small fits, many of them to what no fit should be asked for: what
// isn't finite, what fails and how far a gradient is from numeric differences.
#include <tbb/global_control.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <thread>

#include "base/text.h"
#include "experiment.h"
#include "pbnbrdf/base/error.h"
#include "process.h"
#include "stability_report.h"
#include "stability_run.h"

DEFINE_int32(runs, 5000, "fits");
DEFINE_uint64(seeds, 3, "how many seeds take part");
DEFINE_int32(max_iterations, 12, "of each fit; Adam: epochs");
DEFINE_uint64(samples, 400, "training samples of each fit");
DEFINE_int32(jobs, 2, "processes at a time, each of one thread");
DEFINE_string(sgd, "", "parameters of SGD materials (CSV), which take part too");
DEFINE_int32(first_run, -1, "internal, of a child process: does the runs from this one on");
DEFINE_int32(run_count, 0, "internal: so many");
DEFINE_int32(crash_at, -1, "internal, of tests: this run ends its process as a crash does");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(stability: thousands of small fits, many of them to what no fit should be asked for.

  stability --out_dir=results --runs=5000 --jobs=2

The runs walk through the product of material, stress, solver, loss, terms, encoding, precision,
activation, initialization, sampling and seed: each is the one of 16 random combinations that has
the most pairs of levels that haven't appeared yet (pairwise_walk.h); the report says how many have.
They run in processes of their own, some at a time: one that crashes, or a run that takes longer
than two minutes, costs no other run. Writes stability.csv, a row for each run, and stability.md.
)";

constexpr int kChunk = 25;          // runs of a process
constexpr unsigned kTimeout = 120;  // seconds of a run
constexpr int kSignalStatus = 128;  // of a process that a signal ended, plus the signal

SweepSize Size() {
  return {.seeds = static_cast<std::size_t>(FLAGS_seeds),
          .max_iterations = FLAGS_max_iterations,
          .samples = static_cast<std::size_t>(FLAGS_samples)};
}

std::vector<std::string> FactorNames(const StabilitySweep& sweep) {
  std::vector<std::string> names;
  for (const StabilityFactor& factor : sweep.factors()) names.push_back(factor.name);
  return names;
}

// Does its runs, and writes a row for each to standard output.
void RunChunk() {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  gflags::SetCommandLineOption("minloglevel", "3");  // Ceres tells of each failure
  StabilitySweep sweep(Size(), FLAGS_sgd);
  for (int run = 0; run < FLAGS_first_run + FLAGS_run_count; ++run) {
    const StabilityCase next = sweep.Next();
    if (run < FLAGS_first_run) continue;
    if (run == FLAGS_crash_at) std::abort();
    alarm(kTimeout);
    StabilityRecord record = RunStabilityCase(next);
    record.run = run;
    std::cout << CsvLine(RecordCells(record)) << std::flush;
  }
}

struct Chunk {
  int first, count;
};

// Hands out chunks of runs to child processes and gathers their rows.
class Sweep {
 public:
  Sweep() : sweep_(Size(), FLAGS_sgd), csv_path_(OutputPath("stability.csv")), csv_(csv_path_) {
    csv_ << CsvLine(RecordColumns(FactorNames(sweep_)));
    for (int run = 0; run < FLAGS_runs; ++run) cases_.push_back(sweep_.Next());
    for (int run = 0; run < FLAGS_runs; run += kChunk) {
      chunks_.push_back({run, std::min(kChunk, FLAGS_runs - run)});
    }
  }

  void Run() {
    std::vector<std::thread> workers;
    for (int job = 0; job < FLAGS_jobs; ++job) {
      workers.emplace_back([this] {
        for (Chunk chunk; Take(&chunk);) Finish(chunk, RunProgram(ChildCommand(chunk)));
      });
    }
    for (std::thread& worker : workers) worker.join();
    std::fprintf(stderr, "\n");
    if (!failure_.empty()) Fail(failure_);
  }

  void Report() {
    std::sort(records_.begin(), records_.end(),
              [](const auto& a, const auto& b) { return a.run < b.run; });
    WriteReport("stability",
                StrCat(FLAGS_runs, " runs of at most ", FLAGS_max_iterations, " iterations on ",
                       FLAGS_samples, " samples, 8-8 hidden units. Pairs of levels that appear: ",
                       sweep_.walk().seen_pairs(), " of ", sweep_.walk().possible_pairs(), ".\n\n",
                       StabilityMarkdown(sweep_.factors(), records_)));
  }

 private:
  static std::vector<std::string> ChildCommand(const Chunk& chunk) {
    return {std::filesystem::read_symlink("/proc/self/exe"),
            "--out_dir=" + FLAGS_out_dir,
            StrCat("--seeds=", FLAGS_seeds),
            StrCat("--max_iterations=", FLAGS_max_iterations),
            StrCat("--samples=", FLAGS_samples),
            "--sgd=" + FLAGS_sgd,
            StrCat("--crash_at=", FLAGS_crash_at),
            StrCat("--first_run=", chunk.first),
            StrCat("--run_count=", chunk.count)};
  }

  bool Take(Chunk* chunk) {
    const std::lock_guard lock(mutex_);
    if (chunks_.empty() || !failure_.empty()) return false;
    *chunk = chunks_.front();
    chunks_.pop_front();
    return true;
  }

  // The run that a process died in counts, and those behind it are done by another one.
  void Finish(const Chunk& chunk, const ProgramResult& result) {
    const std::lock_guard lock(mutex_);
    try {
      int done = 0;
      for (const std::string& line : Split(result.output, '\n')) {
        if (line.empty()) continue;
        Add(ParseRecord(Split(line, ','), sweep_.factors().size()));
        ++done;
      }
      if (done < chunk.count) {
        AddDead(chunk.first + done, result.status);
        ++done;
        if (done < chunk.count) chunks_.push_back({chunk.first + done, chunk.count - done});
      }
      if (!csv_.flush()) Fail(csv_path_, ": can't be written");
    } catch (const std::exception& error) {
      failure_ = error.what();
    }
    std::fprintf(stderr, "\r%zu of %d runs, %d not ok", records_.size(), FLAGS_runs, not_ok_);
  }

  void AddDead(int run, int status) {
    StabilityRecord record;
    record.run = run;
    record.levels = cases_[static_cast<std::size_t>(run)].levels;
    record.outcome = status == kSignalStatus + SIGALRM ? "timeout" : "crash";
    record.message = StrCat("process ended with status ", status);
    Add(record);
  }

  void Add(const StabilityRecord& record) {
    records_.push_back(record);
    not_ok_ += record.outcome != "ok";
    csv_ << CsvLine(RecordCells(record));
  }

  StabilitySweep sweep_;
  std::string csv_path_;
  std::ofstream csv_;
  std::vector<StabilityCase> cases_;
  std::mutex mutex_;  // of what follows, and of csv_
  std::deque<Chunk> chunks_;
  std::vector<StabilityRecord> records_;
  int not_ok_ = 0;
  std::string failure_;
};

void Run(const std::vector<std::string>&) {
  if (FLAGS_first_run >= 0) return RunChunk();
  if (FLAGS_runs < 1) Fail("runs = ", FLAGS_runs, "; must be >= 1");
  if (FLAGS_jobs < 1) Fail("jobs = ", FLAGS_jobs, "; must be >= 1");
  if (FLAGS_seeds < 1) Fail("seeds = ", FLAGS_seeds, "; must be >= 1");
  Sweep sweep;
  sweep.Run();
  sweep.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}
