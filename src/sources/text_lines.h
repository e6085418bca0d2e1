// text_lines.h: the lines of a text file, with their numbers.
#pragma once

#include <string>
#include <string_view>

namespace pbnbrdf {

class TextLines {
 public:
  // Throws Error if the file can't be read or is larger than 4 GiB.
  explicit TextLines(const std::string& path);

  // The next line that isn't empty, without blanks at either end; false after the last. Throws Error
  // if that one has no end: the file was cut off.
  bool Next(std::string_view* line);

  // "FILE: line 12", of the line that Next gave.
  std::string Place() const;

  const std::string& path() const { return path_; }

 private:
  std::string path_, text_;
  std::size_t at_ = 0;
  int number_ = 0;
};

}  // namespace pbnbrdf
