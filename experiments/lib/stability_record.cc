#include "stability_record.h"

#include <algorithm>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

// One cell of a line without quotes.
std::string Plain(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

// Takes one cell after the other.
class CellReader {
 public:
  explicit CellReader(const std::vector<std::string>& cells) : cells_(cells) {}

  std::string Text() {
    if (next_ == cells_.size()) Fail("a record of ", cells_.size(), " cells: too few");
    return cells_[next_++];
  }
  int Integer() { return static_cast<int>(ParseInteger("record", Text())); }
  double Number() { return std::stod(Text()); }  // NaN too

 private:
  const std::vector<std::string>& cells_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<std::string> RecordColumns(const std::vector<std::string>& factors) {
  std::vector<std::string> columns = {"run"};
  columns.insert(columns.end(), factors.begin(), factors.end());
  for (const char* name : {"outcome", "message", "non_finite", "termination", "iterations",
                           "restarts", "failed_factorizations", "rejected_steps", "cost", "error",
                           "gradient_error", "directions_resolved", "directions_unresolved"}) {
    columns.emplace_back(name);
  }
  return columns;
}

std::vector<std::string> RecordCells(const StabilityRecord& record) {
  std::vector<std::string> cells = {StrCat(record.run)};
  for (const std::string& level : record.levels) cells.push_back(Plain(level));
  for (const std::string& cell :
       {record.outcome, Plain(record.message), record.non_finite, record.termination,
        StrCat(record.iterations), StrCat(record.restarts), StrCat(record.failed_factorizations),
        StrCat(record.rejected_steps), FormatNumber(record.cost), FormatNumber(record.error),
        FormatNumber(record.gradient.worst_error), StrCat(record.gradient.resolved),
        StrCat(record.gradient.unresolved)}) {
    cells.push_back(cell);
  }
  return cells;
}

StabilityRecord ParseRecord(const std::vector<std::string>& cells, std::size_t factors) {
  CellReader reader(cells);
  StabilityRecord record;
  record.run = reader.Integer();
  for (std::size_t f = 0; f < factors; ++f) record.levels.push_back(reader.Text());
  record.outcome = reader.Text();
  record.message = reader.Text();
  record.non_finite = reader.Text();
  record.termination = reader.Text();
  record.iterations = reader.Integer();
  record.restarts = reader.Integer();
  record.failed_factorizations = reader.Integer();
  record.rejected_steps = reader.Integer();
  record.cost = reader.Number();
  record.error = reader.Number();
  record.gradient.worst_error = reader.Number();
  record.gradient.resolved = reader.Integer();
  record.gradient.unresolved = reader.Integer();
  return record;
}

}  // namespace pbnbrdf
