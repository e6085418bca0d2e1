// direction_csv.h: reads pairs of directions from a CSV file, and appends the values at them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf::cli {

struct DirectionCsv {
  std::string header;
  std::vector<std::string> rows;  // as they are in the file
  std::vector<DirectionPair> pairs;
};

// The header names theta_i,phi_i,theta_o,phi_o (radians) or wi_x,wi_y,wi_z,wo_x,wo_y,wo_z
// (normalised here) among its columns. Blank lines are skipped. Throws Error, naming `file` and the line.
DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text);

// The rows with r,g,b appended, with 17 significant digits.
std::string FormatDirectionCsv(const DirectionCsv& csv, std::span<const Rgb> values);

}  // namespace pbnbrdf::cli
