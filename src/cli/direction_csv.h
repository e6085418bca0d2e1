// direction_csv.h: reads pairs of directions from a CSV file, and appends the values at them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf::cli {

struct DirectionCsv {
  std::string header;
  char separator = ',';
  std::vector<std::string> rows;  // as they are in the file
  std::vector<DirectionPair> pairs;
  std::size_t left_out = 0;  // rows that lack a number
};

// The columns and dialects that a material's CSV may have (scattered_files.h), but for values: if one of r, g, b
// is there already, what is appended would be a second column of that name. Throws Error, naming `file` and the
// line.
DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text);

// The rows with r,g,b appended, with 17 significant digits.
std::string FormatDirectionCsv(const DirectionCsv& csv, std::span<const Rgb> values);

}  // namespace pbnbrdf::cli
