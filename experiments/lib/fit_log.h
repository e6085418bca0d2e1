// fit_log.h: a CSV file with a row for each fit, and a list of the fits that failed.
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

  // Writes the row at once, so that a long run that is stopped leaves its rows.
  void AddRow(const std::vector<std::string>& cells);

  // For a fit that has no row. Also prints the failure to standard error.
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
