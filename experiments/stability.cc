// stability.cc: thousands of small fits, many of them to what no fit should be asked for: what isn't
// finite, what fails and how far a gradient is from numeric differences.
#include <sys/time.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>

#include "base/text.h"
#include "experiment.h"
#include "for_each.h"
#include "pbnbrdf/base/error.h"
#include "process.h"
#include "stability_report.h"
#include "stability_run.h"
#include "table.h"

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(stability: thousands of small fits, many of them to what no fit should be asked for.

  stability --out_dir=results --runs=5000 --jobs=2

A run has a level of each of these factors: material, stress, solver, loss, terms, encoding, precision,
activation, initialization, sampling and seed. Of 16 random combinations each run takes the one with
the most pairs of levels that haven't appeared yet; the report says how many have. Runs are done in
processes of their own, several at a time: one that crashes, or that takes more than five minutes of a
core, costs no other run. Writes stability.csv, a row for each run, and stability.md.
)";

constexpr int kChunk = 25;              // runs of a process
constexpr int kMaxCpuSeconds = 300;     // of a run; the slowest known takes one to two minutes
constexpr unsigned kMaxSeconds = 1200;  // of a run, for one that waits for ever
constexpr int kSignalStatus = 128;      // of a process that a signal ended, plus the signal

struct Options {
  int runs = 5000;
  SweepSize size;
  int jobs = 2;
  std::string sgd;
  int first_run = -1, run_count = 0, crash_at = -1;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(Integer("runs", &o->runs, AtLeast(1), "fits"));
  fields.Add(Integer("seeds", &o->size.seeds, AtLeast(1), "how many seeds take part"));
  fields.Add(Integer("max_iterations", &o->size.max_iterations, AtLeast(0),
                     "iterations of each fit, at most; of adam, epochs"));
  fields.Add(Integer("samples", &o->size.samples, AtLeast(1), "training samples of each fit"));
  fields.Add(Integer("jobs", &o->jobs, AtLeast(1), "processes at a time, each of one thread"));
  fields.Add(Text("sgd", &o->sgd,
                  "CSV of parameters of the SGD model, whose materials then take part too"));
  fields.Group("For child processes and tests");
  fields.Add(Integer("first_run", &o->first_run, {}, "do the runs from this one on; -1: all"));
  fields.Add(Integer("run_count", &o->run_count, AtLeast(0), "do so many of them"));
  fields.Add(Integer("crash_at", &o->crash_at, {}, "crash in this run; -1: in none"));
  return fields;
}

std::vector<std::string> FactorNames(const StabilitySweep& sweep) {
  std::vector<std::string> names;
  for (const StabilityFactor& factor : sweep.factors()) names.push_back(factor.name);
  return names;
}

// Ends this process by a signal when the limits are over, unless it is called again.
void RestartTimeout() {
  const itimerval limit = {.it_interval = {}, .it_value = {.tv_sec = kMaxCpuSeconds, .tv_usec = 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
  alarm(kMaxSeconds);
}

bool IsTimeout(int status) {
  return status == kSignalStatus + SIGPROF || status == kSignalStatus + SIGALRM;
}

// Does its runs, and writes a row for each to standard output.
void RunChunk(const Options& options) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  StabilitySweep sweep(options.size, options.sgd);
  for (int run = 0; run < options.first_run + options.run_count; ++run) {
    const StabilityCase next = sweep.Next();
    if (run < options.first_run) continue;
    if (run == options.crash_at) std::abort();
    RestartTimeout();
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
  Sweep(const Options& options, const Output& output)
      : options_(options),
        output_(output),
        sweep_(options.size, options.sgd),
        csv_path_(output.Path("stability.csv")),
        csv_(csv_path_) {
    csv_ << CsvLine(RecordColumns(FactorNames(sweep_)));
    for (int run = 0; run < options.runs; ++run) cases_.push_back(sweep_.Next());
    for (int run = 0; run < options.runs; run += kChunk) {
      chunks_.push_back({run, std::min(kChunk, options.runs - run)});
    }
  }

  void Run() {
    // In child processes Ceres would log each failure.
    setenv("GLOG_minloglevel", "3", /*overwrite=*/1);
    const auto jobs = static_cast<std::size_t>(options_.jobs);
    ForEach(jobs, options_.jobs, [this](std::size_t) {
      for (Chunk chunk; Take(&chunk);) Finish(chunk, RunProgram(ChildCommand(chunk)));
    });
    std::fprintf(stderr, "\n");
  }

  void Report() {
    std::sort(records_.begin(), records_.end(),
              [](const auto& a, const auto& b) { return a.run < b.run; });
    output_.WriteReport(
        "stability",
        StrCat(options_.runs, " runs of at most ", options_.size.max_iterations, " iterations on ",
               options_.size.samples, " samples, 8-8 hidden units. Pairs of levels that appear: ",
               sweep_.walk().seen_pairs(), " of ", sweep_.walk().possible_pairs(), ".\n\n",
               StabilityMarkdown(sweep_.factors(), records_)));
  }

 private:
  // This program with these options, told to do the runs of a chunk.
  std::vector<std::string> ChildCommand(const Chunk& chunk) const {
    Options options = options_;
    options.first_run = chunk.first;
    options.run_count = chunk.count;
    std::vector<std::string> command = {std::filesystem::read_symlink("/proc/self/exe")};
    for (const std::string& line : Split(FieldsOf(&options).Lines(), '\n')) {
      if (!line.empty()) command.push_back(line);
    }
    return command;
  }

  bool Take(Chunk* chunk) {
    const std::lock_guard lock(mutex_);
    if (chunks_.empty()) return false;
    *chunk = chunks_.front();
    chunks_.pop_front();
    return true;
  }

  // The run that a process died in counts, and those behind it are done by another one.
  void Finish(const Chunk& chunk, const ProgramResult& result) {
    const std::lock_guard lock(mutex_);
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
    std::fprintf(stderr, "\r%zu of %d runs, %d not ok", records_.size(), options_.runs, not_ok_);
  }

  void AddDead(int run, int status) {
    StabilityRecord record;
    record.run = run;
    record.levels = cases_[static_cast<std::size_t>(run)].levels;
    record.outcome = IsTimeout(status) ? "timeout" : "crash";
    record.message = StrCat("process ended with status ", status);
    Add(record);
  }

  void Add(const StabilityRecord& record) {
    records_.push_back(record);
    not_ok_ += record.outcome != "ok";
    csv_ << CsvLine(RecordCells(record));
  }

  const Options& options_;
  const Output& output_;
  StabilitySweep sweep_;
  std::string csv_path_;
  std::ofstream csv_;
  std::vector<StabilityCase> cases_;
  std::mutex mutex_;  // of what follows, and of csv_
  std::deque<Chunk> chunks_;
  std::vector<StabilityRecord> records_;
  int not_ok_ = 0;
};

void Run(const Options& options, const Arguments&, const Output& output) {
  if (options.first_run >= 0) return RunChunk(options);
  Sweep sweep(options, output);
  sweep.Run();
  sweep.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
