// fit_log.h: what many fits leave, some of them at a time: rows of a CSV, and failures.
#pragma once

#include <fstream>
#include <mutex>
#include <string>
#include <vector>

namespace pbnbrdf {

// The members may be called from several threads at once.
class FitLog {
 public:
  // Begins the CSV. Throws Error if it can't be written, as AddRow does.
  FitLog(const std::string& path, const std::vector<std::string>& header);

  // At once, so that a long run that is stopped has left its rows.
  void AddRow(const std::vector<std::string>& cells);

  // A fit that has no row. Said on standard error, too.
  void AddFailure(const std::string& failure);

  // "Failed fits: 1.", and a list of them.
  std::string FailuresMarkdown() const;

 private:
  void Write(const std::vector<std::string>& cells);

  std::string path_;
  std::ofstream csv_;
  std::vector<std::string> failures_;
  mutable std::mutex mutex_;
};

}  // namespace pbnbrdf
