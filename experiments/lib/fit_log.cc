#include "fit_log.h"

#include <cstdio>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "table.h"

namespace pbnbrdf {

FitLog::FitLog(const std::string& path, const std::vector<std::string>& header)
    : path_(path), csv_(path) {
  Write(header);
}

void FitLog::AddRow(const std::vector<std::string>& cells) {
  const std::scoped_lock lock(mutex_);
  Write(cells);
}

void FitLog::Write(const std::vector<std::string>& cells) {
  csv_ << CsvLine(cells);
  if (!csv_.flush()) Fail(path_, ": can't be written");
}

void FitLog::AddFailure(const std::string& failure) {
  const std::scoped_lock lock(mutex_);
  failures_.push_back(failure);
  std::fprintf(stderr, "%s\n", failure.c_str());
}

std::string FitLog::FailuresMarkdown() const {
  const std::scoped_lock lock(mutex_);
  std::string text = StrCat("Failed fits: ", failures_.size(), ".\n\n");
  for (const std::string& failure : failures_) text += "- " + failure + "\n";
  return text + (failures_.empty() ? "" : "\n");
}

}  // namespace pbnbrdf
