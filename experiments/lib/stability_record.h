// stability_record.h: what is recorded of a run of the stability sweep, as a row of CSV.
#pragma once

#include <string>
#include <vector>

#include "gradient_check.h"

namespace pbnbrdf {

struct StabilityRecord {
  int run = 0;
  std::vector<std::string> levels;  // of each factor
  // "ok" | "error": an Error, which says why | "non-finite": something that isn't finite left the
  // library | "crash" | "timeout"
  std::string outcome = "ok";
  std::string message;     // the Error's or the solver's, without commas
  std::string non_finite;  // what wasn't finite
  std::string termination;
  int iterations = 0, restarts = 0, failed_factorizations = 0, rejected_steps = 0;
  double cost = 0.0;
  double error = 0.0;  // mean |eq. 6| on held-out samples
  GradientCheck gradient;
};

// The header, given the factors' names.
std::vector<std::string> RecordColumns(const std::vector<std::string>& factors);

std::vector<std::string> RecordCells(const StabilityRecord& record);

// Back from the cells, `factors` of which are levels. Throws Error unless they are of a record.
StabilityRecord ParseRecord(const std::vector<std::string>& cells, std::size_t factors);

}  // namespace pbnbrdf
