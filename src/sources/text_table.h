// text_table.h: tables in text files: lines of cells, comments, a line that names the columns. Every format of
// text is read through it, so that all errors name file, line and column alike.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

class TextTable {
 public:
  enum class Cells { kCommas, kBlanks };  // what parts them; blanks around cells are dropped

  // path: for messages.
  TextTable(std::string path, std::string text, Cells cells);

  // Throws Error if the file can't be read or is larger than 4 GiB.
  static TextTable Read(const std::string& path, Cells cells);

  // From now on the last line must end like all others, so that a file that was cut off is found.
  void RequireLastLineEnd() { requires_end_ = true; }

  // The next line that isn't empty; false after the last. Throws Error if that one has no end and must.
  bool Next();

  std::string_view line() const { return line_; }  // without blanks at either end
  bool IsComment() const { return line_.starts_with("#"); }
  const std::vector<std::string_view>& cells() const { return cells_of_line_; }

  // "FILE: line 12"
  std::string Place() const;

  // Takes this line's cells as the names of the columns.
  void NameColumns();
  const std::vector<std::string>& names() const { return names_; }
  std::optional<std::size_t> FindColumn(std::string_view name) const;

  // Throws Error "FILE: line 12: 3 columns, expected 4".
  void RequireCells(std::size_t count, std::string_view what = "columns") const;

  // A cell of this line. Throws Error "FILE: line 12, NAME: 'x' is not a finite number"; of a column
  // without a name "FILE: line 12, number 3: ...".
  double Number(std::size_t column) const;

  const std::string& path() const { return path_; }

 private:
  void SplitLine();

  std::string path_, text_;
  Cells cells_;
  bool requires_end_ = false;
  std::size_t at_ = 0;
  int number_ = 0;  // of the line
  std::string_view line_;
  std::vector<std::string_view> cells_of_line_;
  std::vector<std::string> names_;
};

}  // namespace pbnbrdf
