#include "pbnbrdf/sources/astm.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/angles.h"
#include "sources/cie.h"
#include "sources/make_scattered.h"
#include "sources/text_table.h"

namespace pbnbrdf {
namespace {

constexpr std::string_view kVars = "VARS", kNumPoints = "NUM_POINTS", kNanometers = "nm";

struct Columns {
  std::size_t theta_i, theta_s, phi_s;
  std::optional<std::size_t> phi_i;
  std::vector<std::size_t> values;
  std::vector<Rgb> weights;  // of the values
};

// What a line says behind its keyword; none if it begins with another word.
std::optional<std::string_view> Behind(std::string_view line, std::string_view keyword) {
  if (!line.starts_with(keyword)) return std::nullopt;
  line.remove_prefix(keyword.size());
  if (line.find_first_of(" \t") != 0) return std::nullopt;
  return Trim(line);
}

// How the columns of these names become RGB.
std::vector<Rgb> WeightsOf(const TextTable& table, const std::vector<std::string>& names) {
  const auto are = [&](std::initializer_list<const char*> wanted) {
    return std::equal(names.begin(), names.end(), wanted.begin(), wanted.end());
  };
  if (names.size() == 1) return {{1.0, 1.0, 1.0}};
  if (are({"r", "g", "b"})) return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  if (are({"x", "y", "z"})) return XyzToRgb();
  std::vector<float> wavelengths;
  for (std::string_view name : names) {
    if (!name.ends_with(kNanometers)) {
      Fail(table.Place(), ": values must be one, R,G,B, X,Y,Z or wavelengths as 400nm, not ", name);
    }
    name.remove_suffix(kNanometers.size());
    wavelengths.push_back(static_cast<float>(ParseNumber(table.Place(), name)));
    if (wavelengths.size() > 1 && !(wavelengths.end()[-1] > wavelengths.end()[-2])) {
      Fail(table.Place(), ": wavelengths must ascend");
    }
  }
  return SpectrumToRgb(table.path(), wavelengths);
}

Columns FindColumns(const TextTable& table) {
  const auto theta_i = table.FindColumn("theta_i"), theta_s = table.FindColumn("theta_s"),
             phi_s = table.FindColumn("phi_s");
  if (!theta_i || !theta_s || !phi_s) {
    Fail(table.Place(), ": VARS must name theta_i, phi_i, theta_s, phi_s");
  }
  Columns columns = {*theta_i, *theta_s, *phi_s, table.FindColumn("phi_i"), {}, {}};
  std::vector<std::string> names;
  for (std::size_t k = 0; k < table.names().size(); ++k) {
    if (k == theta_i || k == theta_s || k == phi_s || k == columns.phi_i) continue;
    columns.values.push_back(k);
    names.push_back(LowerCase(table.names()[k]));
  }
  if (names.empty()) Fail(table.Place(), ": VARS names no values");
  columns.weights = WeightsOf(table, names);
  return columns;
}

BrdfSample ParseRow(const TextTable& table, const Columns& columns) {
  table.RequireCells(table.names().size());
  const double phi_i = columns.phi_i ? table.Number(*columns.phi_i) : 0.0;
  std::vector<double> values;
  for (std::size_t column : columns.values) values.push_back(table.Number(column));
  BrdfSample sample;
  sample.pair =
      PairFromAngles(table.Place(), {table.Number(columns.theta_i), phi_i,
                                     table.Number(columns.theta_s), table.Number(columns.phi_s)});
  sample.value = WeightedSum(columns.weights, values);
  return sample;
}

}  // namespace

bool LooksLikeAstm(std::string_view start) {
  for (const std::string& line : Split(start, '\n')) {
    const auto names = Behind(line, kVars);
    if (names && names->find("theta_i") != names->npos)
      return names->find("theta_s") != names->npos;
  }
  return false;
}

ScatteredBrdf ReadAstm(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kCommas);
  std::optional<std::size_t> points;
  std::optional<Columns> columns;
  ScatteredData data;
  while (table.Next()) {
    if (columns) {
      data.samples.push_back(ParseRow(table, *columns));
    } else if (const auto count = Behind(table.line(), kNumPoints)) {
      points = static_cast<std::size_t>(ParseInteger<std::uint64_t>(table.Place(), *count));
    } else if (const auto names = Behind(table.line(), kVars)) {
      table.NameColumns(*names);
      columns = FindColumns(table);
    }
  }
  if (!columns) Fail(path, ": not an ASTM file: no line VARS");
  if (points && *points != data.samples.size()) {
    Fail(path, ": ", data.samples.size(), " rows, NUM_POINTS says ", *points,
         "; is the file truncated?");
  }
  data.kind = "ASTM measurements";
  data.channels = columns->values.size() == 1 ? 1 : 3;
  data.isotropic = HaveOneIncidentAzimuth(data.samples);
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
