#include "direction_csv.h"

#include <optional>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "sources/direction_columns.h"

namespace pbnbrdf::cli {
namespace {

constexpr const char* kAppended[] = {"r", "g", "b"};

// From the first line that isn't a comment, or from a comment before it.
DirectionColumns FindColumns(TextTable* table) {
  while (table->Next()) {
    if (const auto columns = DirectionColumns::Find(table)) return *columns;
    if (!table->IsComment()) break;
  }
  Fail(table->path(), ": the first line must name the columns ", kDirectionColumns);
}

}  // namespace

DirectionCsv ParseDirectionCsv(const std::string& file, const std::string& text) {
  TextTable table(file, text, TextTable::Cells::kFound);
  const DirectionColumns directions = FindColumns(&table);
  for (const char* name : kAppended) {
    if (table.FindColumn(name)) {
      Fail(table.Place(), ": there is a column ", name, " already; r,g,b are what is appended");
    }
  }
  DirectionCsv csv;
  csv.header = table.line();
  csv.separator = table.separator();
  while (table.Next()) {
    if (table.IsComment()) continue;
    table.RequireCells(table.names().size());
    if (directions.AreMissing(table)) {
      ++csv.left_out;
      continue;
    }
    csv.pairs.push_back(directions.Parse(table));
    csv.rows.emplace_back(table.line());
  }
  return csv;
}

std::string FormatDirectionCsv(const DirectionCsv& csv, std::span<const Rgb> values) {
  std::string text = csv.header;
  for (const char* name : kAppended) text += csv.separator + std::string(name);
  text += "\n";
  for (std::size_t n = 0; n < values.size(); ++n) {
    text += csv.rows[n];
    for (double value : values[n]) text += csv.separator + FormatFullPrecision(value);
    text += "\n";
  }
  return text;
}

}  // namespace pbnbrdf::cli
