// ReadScatteredCsv of scattered_files.h.
#include <algorithm>
#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/sources/scattered_files.h"
#include "sources/direction_columns.h"
#include "sources/make_scattered.h"

namespace pbnbrdf {
namespace {

struct Columns {
  DirectionColumns directions;
  std::vector<std::size_t> values;  // of R, G, B, or of the only channel
};

// From the line that names the columns.
Columns FindColumns(TextTable* table) {
  table->NameColumns();
  std::vector<std::size_t> values;
  for (const char* name : {"r", "g", "b"}) {
    if (const auto at = table->FindColumn(name)) values.push_back(*at);
  }
  if (values.size() != 3) {
    values.clear();
    if (const auto at = table->FindColumn("value")) values.push_back(*at);
  }
  const auto directions = DirectionColumns::Find(*table);
  if (values.empty() || !directions) {
    Fail(table->Place(), ": the first line must name the columns ", kDirectionColumns,
         ", and value or r,g,b");
  }
  return {*directions, values};
}

BrdfSample ParseRow(const TextTable& table, const Columns& columns) {
  table.RequireCells(table.names().size());
  BrdfSample sample;
  sample.pair = columns.directions.Parse(table);
  for (std::size_t c = 0; c < 3; ++c) {
    sample.value[c] = table.Number(columns.values[std::min(c, columns.values.size() - 1)]);
  }
  return sample;
}

}  // namespace

ScatteredBrdf ReadScatteredCsv(const std::string& path) {
  TextTable table = TextTable::Read(path, TextTable::Cells::kCommas);
  table.RequireLastLineEnd();
  std::optional<Columns> columns;
  std::optional<bool> said_isotropic;
  ScatteredData data;
  while (table.Next()) {
    if (table.IsComment()) {
      const std::string_view comment = Trim(table.line().substr(1));
      if (comment == "isotropic" || comment == "anisotropic") {
        said_isotropic = comment == "isotropic";
      }
    } else if (!columns) {
      columns = FindColumns(&table);
    } else {
      data.samples.push_back(ParseRow(table, *columns));
    }
  }
  if (!columns) {
    Fail(path, ": no line that names the columns ", kDirectionColumns, ", and value or r,g,b");
  }
  data.kind = "CSV measurements";
  data.channels = static_cast<int>(columns->values.size());
  data.isotropic = said_isotropic.value_or(HaveOneIncidentAzimuth(data.samples));
  return MakeScattered(path, std::move(data));
}

}  // namespace pbnbrdf
