// stability_report.h: the runs of the stability sweep as tables.
#pragma once

#include <string>
#include <vector>

#include "stability_case.h"
#include "stability_record.h"

namespace pbnbrdf {

// A table for each factor, with a row for each level: runs, outcomes, what the solvers met, the
// worst error as a ratio to the median of its group (the same material, solver and terms, ok runs
// only) and the worst gradient error; then the kinds of Errors, numbers in their messages left out.
std::string StabilityMarkdown(const std::vector<StabilityFactor>& factors,
                              const std::vector<StabilityRecord>& records);

// The message with each number in it as '#'.
std::string MessageKind(const std::string& message);

// A median below this counts as this: that of a group that fits to rounding is no measure.
inline constexpr double kMinMedian = 1e-4;

// Each record's error over the median of its group, or NaN unless its outcome is "ok".
std::vector<double> ErrorRatios(const std::vector<StabilityFactor>& factors,
                                const std::vector<StabilityRecord>& records);

}  // namespace pbnbrdf
