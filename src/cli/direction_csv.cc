#include "direction_csv.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf::cli {
namespace {

constexpr std::array<const char*, 4> kAngles = {"theta_i", "phi_i", "theta_o", "phi_o"};
constexpr std::array<const char*, 6> kVectors = {"wi_x", "wi_y", "wi_z", "wo_x", "wo_y", "wo_z"};

// The columns' positions, if the header has them all.
template <std::size_t N>
std::optional<std::array<std::size_t, N>> Find(const std::vector<std::string>& header,
                                               const std::array<const char*, N>& names) {
  std::array<std::size_t, N> columns;
  for (std::size_t i = 0; i < N; ++i) {
    const auto found = std::find(header.begin(), header.end(), names[i]);
    if (found == header.end()) return std::nullopt;
    columns[i] = static_cast<std::size_t>(found - header.begin());
  }
  return columns;
}

template <std::size_t N>
std::array<double, N> Numbers(const std::string& place, const std::vector<std::string>& row,
                              const std::array<std::size_t, N>& columns,
                              const std::array<const char*, N>& names) {
  std::array<double, N> numbers;
  for (std::size_t i = 0; i < N; ++i) {
    numbers[i] = ParseNumber(StrCat(place, ", ", names[i]), row[columns[i]]);
  }
  return numbers;
}

Vec3 Unit(const std::string& place, const Vec3& v) {
  const double length = std::hypot(v.x, v.y, v.z);
  if (!(length > 0.0) || !std::isfinite(length)) Fail(place, ": a direction has no length");
  return {v.x / length, v.y / length, v.z / length};
}

}  // namespace

DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text) {
  std::istringstream in(text);
  DirectionCsv csv;
  std::getline(in, csv.header);
  csv.header = Trim(csv.header);
  const std::vector<std::string> header = Split(csv.header, ',');
  const auto angles = Find(header, kAngles);
  const auto vectors = Find(header, kVectors);
  if (!angles && !vectors) {
    Fail(file, ": the first line must name the columns theta_i,phi_i,theta_o,phi_o or ",
         "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z");
  }
  std::string line;
  for (int number = 2; std::getline(in, line); ++number) {
    const std::string text_row(Trim(line));
    if (text_row.empty()) continue;
    const std::string place = StrCat(file, ": line ", number);
    const std::vector<std::string> row = Split(text_row, ',');
    if (row.size() != header.size()) {
      Fail(place, ": ", row.size(), " columns, expected ", header.size());
    }
    if (angles) {
      const auto [theta_i, phi_i, theta_o, phi_o] = Numbers(place, row, *angles, kAngles);
      csv.pairs.push_back({FromSpherical(theta_i, phi_i), FromSpherical(theta_o, phi_o)});
    } else {
      const auto v = Numbers(place, row, *vectors, kVectors);
      csv.pairs.push_back({Unit(place, {v[0], v[1], v[2]}), Unit(place, {v[3], v[4], v[5]})});
    }
    csv.rows.push_back(text_row);
  }
  return csv;
}

std::string FormatDirectionCsv(const DirectionCsv& csv, std::span<const Rgb> values) {
  std::string text = csv.header + ",r,g,b\n";
  for (std::size_t n = 0; n < values.size(); ++n) {
    text += csv.rows[n];
    for (double value : values[n]) text += "," + FormatFullPrecision(value);
    text += "\n";
  }
  return text;
}

}  // namespace pbnbrdf::cli
