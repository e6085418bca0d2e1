#include "sources/text_table.h"

#include <algorithm>

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxFileSize = std::uintmax_t{4} << 30;  // bytes

}  // namespace

TextTable::TextTable(std::string path, std::string text, Cells cells)
    : path_(std::move(path)), text_(std::move(text)), cells_(cells) {}

TextTable TextTable::Read(const std::string& path, Cells cells) {
  return TextTable(path, ReadFile(path, kMaxFileSize), cells);
}

bool TextTable::Next() {
  while (at_ < text_.size()) {
    ++number_;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    if (end == text_.size() && requires_end_) {
      Fail(Place(), ": the last line has no end; is the file truncated?");
    }
    line_ = Trim(std::string_view(text_).substr(at_, end - at_));
    at_ = end + 1;
    if (line_.empty()) continue;
    SplitLine();
    return true;
  }
  return false;
}

void TextTable::SplitLine() {
  cells_of_line_.clear();
  std::string_view rest = line_;
  if (cells_ == Cells::kBlanks) {
    for (; !rest.empty(); rest = Trim(rest)) {
      const std::size_t end = std::min(rest.find_first_of(" \t"), rest.size());
      cells_of_line_.push_back(rest.substr(0, end));
      rest.remove_prefix(end);
    }
    return;
  }
  while (true) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    cells_of_line_.push_back(Trim(rest.substr(0, end)));
    if (end == rest.size()) return;
    rest.remove_prefix(end + 1);
  }
}

std::string TextTable::Place() const { return StrCat(path_, ": line ", number_); }

void TextTable::NameColumns() { names_.assign(cells_of_line_.begin(), cells_of_line_.end()); }

std::optional<std::size_t> TextTable::FindColumn(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names_.begin());
}

void TextTable::RequireCells(std::size_t count, std::string_view what) const {
  if (cells_of_line_.size() == count) return;
  Fail(Place(), ": ", cells_of_line_.size(), " ", what, ", expected ", count);
}

double TextTable::Number(std::size_t column) const {
  const std::string name = column < names_.size() ? names_[column] : StrCat("number ", column + 1);
  return ParseNumber(StrCat(Place(), ", ", name), cells_of_line_[column]);
}

}  // namespace pbnbrdf
