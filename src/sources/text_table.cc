#include "sources/text_table.h"

#include <algorithm>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxTextBytes = std::uintmax_t{4} << 30;  // bytes
constexpr std::string_view kBlanks = " \t";
constexpr std::string_view kMissing[] = {"",     "nan",  "-nan", "na", "n/a",
                                         "#n/a", "null", "none", "-",  "--"};
constexpr std::size_t kMaxMissing = 4;   // letters
constexpr std::size_t kUtf16Bytes = 16;  // that tell UTF-16 without its mark

// Where the first cell of `line` ends; a separator between quotes ends none. Quotes that are part of a cell are
// written twice.
std::size_t CellEnd(std::string_view line, std::string_view separators) {
  std::size_t from = 0, quote = line.find_first_not_of(kBlanks);
  while (quote < line.size() && line[quote] == '"') {
    const std::size_t end = line.find('"', quote + 1);
    if (end == line.npos) break;
    from = quote = end + 1;
  }
  return std::min(line.find_first_of(separators, from), line.size());
}

std::string_view WithoutQuotes(std::string_view cell) {
  cell = Trim(cell);
  const bool quoted = cell.size() >= 2 && cell.front() == cell.back() &&
                      (cell.front() == '"' || cell.front() == '\'');
  return quoted ? Trim(cell.substr(1, cell.size() - 2)) : cell;
}

void SplitCells(std::string_view line, char separator, std::vector<std::string_view>* cells) {
  cells->clear();
  const std::string_view separators = separator == ' ' ? kBlanks : std::string_view(&separator, 1);
  while (true) {
    const std::size_t end = CellEnd(line, separators);
    cells->push_back(WithoutQuotes(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = Trim(line);
  }
}

std::string_view WithoutEnds(std::string_view text, std::string_view letters) {
  const std::size_t begin = std::min(text.find_first_not_of(letters), text.size());
  return text.substr(begin, text.find_last_not_of(letters) + 1 - begin);
}

char FindSeparator(std::string_view line) {
  for (char separator : {';', ','}) {
    if (line.find(separator) != line.npos) return separator;
  }
  std::vector<std::string_view> at_tabs;
  SplitCells(line, '\t', &at_tabs);
  const bool tabs = std::all_of(at_tabs.begin(), at_tabs.end(), [](std::string_view cell) {
    return !cell.empty() && cell.find(' ') == cell.npos;
  });
  return tabs && at_tabs.size() > 1 ? '\t' : ' ';
}

}  // namespace

TextTable::TextTable(std::string path, std::string text, Cells cells)
    : path_(std::move(path)), text_(std::move(text)), cells_(cells) {
  if (LooksLikeUtf16(text_)) Fail(path_, ": UTF-16 text; save it as UTF-8");
  if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  if (text_.find('\n') == text_.npos) line_end_ = '\r';
  if (cells_ == Cells::kBlanks) separator_ = ' ';
}

TextTable TextTable::Read(const std::string& path, Cells cells) {
  return TextTable(path, ReadFile(path, kMaxTextBytes), cells);
}

bool TextTable::Next() {
  while (at_ < text_.size()) {
    ++number_;
    const std::size_t end = std::min(text_.find(line_end_, at_), text_.size());
    const std::string_view line = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    line_ = Trim(line);
    if (line_.empty()) continue;
    if (cells_ == Cells::kFound && names_.empty()) separator_ = FindSeparator(line_);
    if (separator_ == '\t') line_ = WithoutEnds(line, " \r");
    SplitCells(line_, separator_, &cells_of_line_);
    return true;
  }
  return false;
}

std::string TextTable::Place() const { return StrCat(path_, ": line ", number_); }

void TextTable::NameColumns() { NameColumns(IsComment() ? WithoutEnds(line_, "# \t") : line_); }

void TextTable::NameColumns(std::string_view line) {
  std::vector<std::string_view> names;
  SplitCells(line, separator_, &names);
  names_.assign(names.begin(), names.end());
}

std::optional<std::size_t> TextTable::FindColumn(std::string_view name) const {
  std::optional<std::size_t> found;
  for (std::size_t column = 0; column < names_.size(); ++column) {
    if (LowerCase(names_[column]) != name) continue;
    if (found) Fail(path_, ": two columns have the name ", name);
    found = column;
  }
  return found;
}

std::vector<std::size_t> TextTable::FindColumns(std::span<const char* const> names) const {
  std::vector<std::size_t> columns;
  for (const char* name : names) {
    if (const auto at = FindColumn(name)) columns.push_back(*at);
  }
  return columns;
}

void TextTable::RequireCells(std::size_t count, std::string_view what) const {
  if (cells_of_line_.size() == count) return;
  Fail(Place(), ": ", cells_of_line_.size(), " ", what, ", expected ", count,
       separator_ == ',' && cells_of_line_.size() > count ? "; is there a decimal comma?" : "");
}

bool TextTable::IsMissing(std::size_t column) const {
  if (cells_of_line_[column].size() > kMaxMissing) return false;
  const std::string cell = LowerCase(cells_of_line_[column]);
  return std::find(std::begin(kMissing), std::end(kMissing), cell) != std::end(kMissing);
}

double TextTable::Number(std::size_t column) const {
  const std::string name = column < names_.size() ? names_[column] : StrCat("number ", column + 1);
  const std::string place = StrCat(Place(), ", ", name);
  const std::string_view cell = cells_of_line_[column];
  const std::size_t comma = cell.find(',');
  if (comma != cell.npos && comma + 1 < cell.size()) {
    Fail(place, ": '", cell, "' has a decimal comma; write a point");
  }
  const std::size_t exponent = cell.find_first_not_of("+-.0123456789");
  if (exponent == cell.npos || exponent == 0 || (cell[exponent] != 'd' && cell[exponent] != 'D')) {
    return ParseNumber(place, cell);
  }
  std::string with_e(cell);
  with_e[exponent] = 'e';
  return ParseNumber(place, with_e);
}

bool LooksLikeUtf16(std::string_view start) {
  if (start.starts_with("\xff\xfe") || start.starts_with("\xfe\xff")) return true;
  // Each character of ASCII has a zero byte before or behind it.
  start = start.substr(0, kUtf16Bytes);
  const auto zeros = [&](std::size_t from) {
    for (std::size_t n = 0; n < start.size(); ++n) {
      if ((start[n] == '\0') != (n % 2 == from)) return false;
    }
    return true;
  };
  return start.size() == kUtf16Bytes && (zeros(0) || zeros(1));
}

}  // namespace pbnbrdf
