#include "table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Row = std::vector<std::string>;

bool IsNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return text == "-" || (!text.empty() && (*end == '\0' || std::string(end) == " x"));
}

std::string MarkdownLine(const Row& cells, const std::vector<std::size_t>& widths,
                         const std::vector<bool>& right) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string blanks(widths[i] - cells[i].size(), ' ');
    line.append(" ").append(right[i] ? blanks + cells[i] : cells[i] + blanks).append(" |");
  }
  return line + "\n";
}

}  // namespace

void Table::Add(Row row) {
  if (row.size() != columns_.size()) {
    Fail("a row of ", row.size(), " cells in a table of ", columns_.size(), " columns");
  }
  rows_.push_back(std::move(row));
}

std::string Table::Markdown() const {
  std::vector<std::size_t> widths;
  std::vector<bool> right;
  Row rule;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    std::size_t width = columns_[i].size();
    bool numbers = true;
    for (const Row& row : rows_) {
      width = std::max(width, row[i].size());
      numbers = numbers && IsNumber(row[i]);
    }
    widths.push_back(std::max<std::size_t>(width, 3));
    right.push_back(numbers);
    rule.push_back(std::string(widths[i] - 1, '-') + (numbers ? ":" : "-"));
  }
  std::string text = MarkdownLine(columns_, widths, right) + MarkdownLine(rule, widths, right);
  for (const Row& row : rows_) text += MarkdownLine(row, widths, right);
  return text;
}

std::string Table::Csv() const {
  std::string text = CsvLine(columns_);
  for (const Row& row : rows_) text += CsvLine(row);
  return text;
}

std::string CsvLine(const Row& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (&cell != &cells.front()) line += ",";
    if (cell.find_first_of(",\"\n") == std::string::npos) {
      line += cell;
      continue;
    }
    line += '"';
    for (char c : cell) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

std::string Significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[64];
  const int exponent = value == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  std::snprintf(text, sizeof(text), "%.*f", std::clamp(digits - 1 - exponent, 0, 12), value);
  return text;
}

}  // namespace pbnbrdf
