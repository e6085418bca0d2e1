// table.h: a table of text, as Markdown and as CSV.
#pragma once

#include <string>
#include <vector>

namespace pbnbrdf {

class Table {
 public:
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  // As many cells as there are columns.
  void Add(std::vector<std::string> row);

  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

  // Columns of equal width, numbers to the right.
  std::string Markdown() const;

  // A header and a line for each row; cells with commas or quotes are quoted.
  std::string Csv() const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

// One line of CSV, its end included.
std::string CsvLine(const std::vector<std::string>& cells);

// `digits` significant ones, "1.20"; "-" unless the value is finite.
std::string Significant(double value, int digits);

}  // namespace pbnbrdf
