#include "fit_collection.h"

#include <atomic>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "base/hash.h"
#include "base/parallel.h"
#include "base/text.h"
#include "pbnbrdf/base/files.h"
#include "progress.h"
#include "sources/source_list.h"

namespace pbnbrdf::cli {
namespace {

constexpr char kTable[] = "fits";  // the name of the table's files
constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 24;

// The columns of the table that come from a fit's summary.
constexpr const char* kListedMeasures[] = {"mean_abs_log_error",
                                           "relative_error",
                                           "reciprocal_floor",
                                           "max_directional_albedo",
                                           "energy",
                                           "delta_e_mean",
                                           "parameters",
                                           "iterations",
                                           "termination",
                                           "seconds"};

enum class State { kWaiting, kKept, kFitted, kFailed };

constexpr NameTable<State, 4> kStates = {{{"waiting", State::kWaiting},
                                          {"kept", State::kKept},
                                          {"fitted", State::kFitted},
                                          {"failed", State::kFailed}}};

struct Entry {
  std::string name, source;
  State state = State::kWaiting;
  std::string why = {};  // it failed
  Json summary = {};     // of the fit, if there is one
  double seconds = 0.0;  // to open, fit and measure it in this run
};

// Of what all the fits start from.
std::string FingerprintOfStart(const FitRequest& request) {
  std::string text;
  for (const std::string& file : {request.init, request.prior}) {
    if (!file.empty()) text += StrCat(SourceFingerprint(file), " ");
  }
  return text;
}

// Of all that a fit depends on; the number of threads isn't part of it.
std::string FingerprintOf(const FitRequest& request, const std::string& start) {
  FitRequest copy = request;
  Fingerprint fingerprint;
  fingerprint.Add(PBNBRDF_VERSION);
  fingerprint.Add(SubjectFields(&copy).Lines());
  fingerprint.Add(ProblemText(request.setup));
  fingerprint.Add(StrCat(SourceFingerprint(request.material.source)));
  fingerprint.Add(start);
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << fingerprint.value();
  return text.str();
}

// One for each source; each has a name of its own, which files can have.
std::vector<Entry> EntriesOf(const std::string& text) {
  const std::vector<std::string> sources = ExpandSources(text), names = NamesOfSources(sources);
  std::vector<Entry> entries;
  for (std::size_t n = 0; n < sources.size(); ++n) {
    if (names[n].empty() || names[n] == kTable || names[n].find('/') != std::string::npos) {
      Fail(sources[n], ": its files can't be named '", names[n], "'");
    }
    entries.push_back({names[n], sources[n]});
  }
  return entries;
}

// Those that have one of the names between semicolons. Throws Error, which has the name, if there is no such entry.
std::vector<Entry> Chosen(const std::vector<Entry>& entries, const std::string& names) {
  std::vector<Entry> chosen;
  for (const std::string& name : Split(names, ';')) {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry& entry) { return entry.name == name; });
    if (found == entries.end()) Fail("only: no material is named '", name, "'");
    chosen.push_back(*found);
  }
  return chosen;
}

// A field of CSV, in quotes if need be.
std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string CsvField(const Json& value) {
  if (value.is_null()) return "";
  return CsvField(value.is_string() ? value.get<std::string>() : JsonLine(value));
}

class Collection {
 public:
  Collection(const FitRequest& request, const CollectionOptions& options)
      : request_(request),
        options_(options),
        entries_(EntriesOf(request.material.source)),
        start_(FingerprintOfStart(request)) {
    if (!options.only.empty()) entries_ = Chosen(entries_, options.only);
  }

  int Run() {
    std::error_code code;
    std::filesystem::create_directories(options_.out_dir, code);
    CheckWritable(File(kTable, ".csv"));
    RemovePartialFiles(options_.out_dir);
    RunJobs();
    line_.Clear();
    if (!options_.only.empty()) return Conclude();
    WriteTable();
    if (options_.when_done && !Interrupted()) options_.when_done();
    return Conclude();
  }

 private:
  std::string File(const std::string& name, const std::string& ending) const {
    return std::filesystem::path(options_.out_dir) / (name + ending);
  }

  void RunJobs() {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const int jobs = options_.jobs > 0 ? options_.jobs : cores;
    threads_ = request_.setup.options.threads;
    if (threads_ == 0) threads_ = std::max(1, cores / jobs);
    std::vector<std::thread> threads;
    for (int job = 0; job < jobs; ++job) {
      threads.emplace_back([this] { RunNextOnes(); });
    }
    for (std::thread& thread : threads) thread.join();
  }

  void RunNextOnes() {
    for (std::size_t n = next_++; n < entries_.size() && !Interrupted(); n = next_++) {
      Entry& entry = entries_[n];
      Entry done = entry;
      try {
        Fit(&done);
      } catch (const std::exception& error) {
        done.state = State::kFailed;
        done.why = error.what();
      }
      const std::lock_guard lock(mutex_);
      entry = std::move(done);
      Report(entry);
    }
  }

  // Leaves the entry waiting if Ctrl-C ended the fit.
  void Fit(Entry* entry) {
    FitRequest request = request_;
    request.material.source = entry->source;
    request.setup.options.threads = threads_;
    const std::string fingerprint = FingerprintOf(request, start_);
    if (std::optional<Json> summary = Kept(entry->name, fingerprint)) {
      entry->state = State::kKept;
      entry->summary = std::move(*summary);
      return;
    }
    WithThreads(threads_, [&] {
      const Timer timer;
      FittedMaterial fitted = MaterialFitter(request).Run(
          /*reports_heldout_error=*/false, [](const FitProgress&) { return !Interrupted(); });
      entry->seconds = timer.Seconds();
      if (fitted.fit.summary.termination == Termination::kInterrupted) return;
      fitted.subject.fingerprint = fingerprint;
      entry->summary = FitSummaryJson(fitted.fit, fitted.subject, fitted.measures);
      // The network comes last: it alone tells that the fit is done.
      WriteFile(File(entry->name, ".json"), JsonText(entry->summary));
      WithMetadata(fitted.fit, fitted.subject, fitted.measures)
          .Write(File(entry->name, ".safetensors"));
      entry->state = State::kFitted;
    });
  }

  // The summary of the fit that the folder has, if it is the same fit.
  std::optional<Json> Kept(const std::string& name, const std::string& fingerprint) const {
    const std::string network = File(name, ".safetensors"), summary = File(name, ".json");
    if (!std::filesystem::exists(network) || !std::filesystem::exists(summary)) return {};
    try {
      const std::map<std::string, std::string> metadata = NeuralBrdf::Read(network).metadata();
      const auto found = metadata.find("fingerprint");
      if (found == metadata.end() || found->second != fingerprint) return {};
      Json json = ParseJson(ReadFile(summary, kMaxJsonBytes));
      return json.is_object() ? std::optional(std::move(json)) : std::nullopt;
    } catch (const Error&) {
      return {};  // damaged: fitted again
    }
  }

  // With the lock.
  void Report(const Entry& entry) {
    ++counts_[entry.state];
    const std::size_t done = entries_.size() - Waiting();
    const std::size_t worked = counts_[State::kFitted] + counts_[State::kFailed];
    const double seconds = timer_.Seconds();
    const double left = worked > 0 ? seconds * double(Waiting()) / double(worked) : 0.0;
    if (options_.progress == ProgressStyle::kJson) {
      std::cerr << JsonLine({{"material", entry.name},
                             {"state", NameOf(kStates, entry.state)},
                             {"why", entry.why},
                             {"done", done},
                             {"failed", counts_[State::kFailed]},
                             {"of", entries_.size()},
                             {"seconds", seconds},
                             {"seconds_left", left}})
                << "\n";
      return;
    }
    line_.Show(StrCat(done, " of ", entries_.size(), " done, ", counts_[State::kFailed],
                      " failed, about ", SecondsText(left), " left  ", entry.name));
  }

  std::size_t Waiting() const {
    std::size_t waiting = entries_.size();
    for (const auto& [state, count] : counts_) waiting -= state == State::kWaiting ? 0 : count;
    return waiting;
  }

  void WriteTable() const {
    std::string csv = "name,source,state,why";
    for (const char* measure : kListedMeasures) csv += StrCat(",", measure);
    csv += "\n";
    Json rows = Json::array();
    double fit_seconds = 0.0;
    for (const Entry& entry : entries_) {
      fit_seconds += entry.seconds;
      csv += StrCat(CsvField(entry.name), ",", CsvField(entry.source), ",",
                    NameOf(kStates, entry.state), ",", CsvField(entry.why));
      Json row = {{"name", entry.name},
                  {"source", entry.source},
                  {"state", NameOf(kStates, entry.state)},
                  {"why", entry.why}};
      for (const char* measure : kListedMeasures) {
        const Json value = entry.summary.is_null() ? Json() : entry.summary.value(measure, Json());
        csv += StrCat(",", CsvField(value));
        row[measure] = value;
      }
      csv += "\n";
      rows.push_back(std::move(row));
    }
    const Json json = {{"version", PBNBRDF_VERSION},
                       {"seconds", timer_.Seconds()},
                       {"job_seconds_in_fits", fit_seconds},
                       {"fits", rows}};
    WriteFiles({{File(kTable, ".csv"), csv}, {File(kTable, ".json"), JsonText(json)}});
  }

  int Conclude() {
    if (!options_.quiet) {
      std::cout << options_.out_dir << ": " << counts_[State::kFitted] << " fitted, "
                << counts_[State::kKept] << " kept, " << counts_[State::kFailed] << " failed, "
                << SecondsText(timer_.Seconds()) << "\n";
    }
    if (Interrupted()) Fail("interrupted; ", Waiting(), " wait: the same command goes on");
    if (counts_[State::kFailed] > 0) {
      Fail(counts_[State::kFailed], " of ", entries_.size(), " materials failed; ",
           options_.only.empty() ? File(kTable, ".csv") + " says why" : FirstFailure());
    }
    return 0;
  }

  std::string FirstFailure() const {
    const auto failed = std::find_if(entries_.begin(), entries_.end(), [](const Entry& entry) {
      return entry.state == State::kFailed;
    });
    return StrCat(failed->name, ": ", failed->why);
  }

  const FitRequest& request_;
  const CollectionOptions& options_;
  std::vector<Entry> entries_;
  const std::string start_;
  const Timer timer_;
  const ProgressLine line_{options_.quiet};
  int threads_ = 1;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::map<State, std::size_t> counts_;
};

}  // namespace

int FitCollection(const FitRequest& request, const CollectionOptions& options) {
  return Collection(request, options).Run();
}

std::vector<std::string> CollectionNames(const std::string& source) {
  std::vector<std::string> names;
  for (const Entry& entry : EntriesOf(source)) names.push_back(entry.name);
  return names;
}

}  // namespace pbnbrdf::cli
