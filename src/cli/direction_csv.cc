#include "direction_csv.h"

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/direction_columns.h"

namespace pbnbrdf::cli {

DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text) {
  TextTable table(file, text, TextTable::Cells::kCommas);
  DirectionCsv csv;
  if (table.Next()) {
    csv.header = table.line();
    table.NameColumns();
  }
  const auto directions = DirectionColumns::Find(table);
  if (!directions) Fail(file, ": the first line must name the columns ", kDirectionColumns);
  while (table.Next()) {
    table.RequireCells(table.names().size());
    csv.pairs.push_back(directions->Parse(table));
    csv.rows.emplace_back(table.line());
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
