// text_table.h: tables in text files: lines of cells, comments, a line that names the columns. Every format of
// text is read through it, so that all errors name file, line and column alike, and all take the same dialects:
// a byte order mark, line ends of any system, none at the end of the file, quotes around cells, Fortran's exponents.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

class TextTable {
 public:
  // What parts cells; blanks around them are dropped. kFound: what the line of names has, the first of
  // ';', ',', tab and blanks. A tab parts cells only where no name would be empty.
  enum class Cells { kFound, kCommas, kBlanks };

  // path: for messages. Throws Error if the text is UTF-16.
  TextTable(std::string path, std::string text, Cells cells);

  // Throws Error if the file can't be read or is larger than 4 GiB.
  static TextTable Read(const std::string& path, Cells cells);

  // The next line that isn't empty; false after the last.
  bool Next();

  std::string_view line() const {
    return line_;
  }  // without blanks at either end that part no cells
  bool IsComment() const { return line_.starts_with("#"); }
  const std::vector<std::string_view>& cells() const { return cells_of_line_; }  // without quotes
  char separator() const { return separator_; }                                  // ' ' for blanks

  // "FILE: line 12"
  std::string Place() const;

  // Takes this line's cells, or those of another line, as the names of the columns; a comment's without its "#".
  void NameColumns();
  void NameColumns(std::string_view line);
  void ForgetNames() { names_.clear(); }
  const std::vector<std::string>& names() const { return names_; }

  // Whatever its capitals. Throws Error if two columns have that name.
  std::optional<std::size_t> FindColumn(std::string_view name) const;

  // Where those are that there are, in the order of the names.
  std::vector<std::size_t> FindColumns(std::span<const char* const> names) const;

  // Throws Error "FILE: line 12: 3 columns, expected 4".
  void RequireCells(std::size_t count, std::string_view what = "columns") const;

  // Whether a cell of this line says that there is no number: empty, nan, NA, null, -, ...
  bool IsMissing(std::size_t column) const;

  // A cell of this line. Throws Error "FILE: line 12, NAME: 'x' is not a finite number"; of a column
  // without a name "FILE: line 12, number 3: ...". Fortran's 1.5D-3 is one, too.
  double Number(std::size_t column) const;

  const std::string& path() const { return path_; }

 private:
  std::string path_, text_;
  Cells cells_;
  char separator_ = ',', line_end_ = '\n';
  std::size_t at_ = 0;
  int number_ = 0;  // of the line
  std::string_view line_;
  std::vector<std::string_view> cells_of_line_;
  std::vector<std::string> names_;
};

// Whether a text begins as UTF-16 does, with its byte order mark or without.
bool LooksLikeUtf16(std::string_view start);

}  // namespace pbnbrdf
