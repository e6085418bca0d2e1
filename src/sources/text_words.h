// text_words.h: a text as words between blanks, one after the other, whatever its lines. From a word that begins
// with # to the end of its line is a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sources/text_table.h"

namespace pbnbrdf {

class TextWords {
 public:
  // Cells::kBlanks
  explicit TextWords(TextTable table) : table_(std::move(table)) {}

  // The next word; false after the last.
  bool Next();

  std::string_view word() const { return table_.cells()[at_]; }
  double Number() const { return table_.Number(at_); }
  std::string Place() const { return table_.Place(); }  // of the word

  // The next word, or number, or numbers. Throw Error, naming what was expected, if there is none.
  std::string_view NextWord(std::string_view what);
  double NextNumber(std::string_view what);
  std::vector<double> NextNumbers(std::size_t count, std::string_view what);

  // The next word: a whole number from 1 to `most`.
  std::size_t NextCount(std::size_t most, std::string_view what);

  [[noreturn]] void FailTruncated(std::string_view what) const;

 private:
  TextTable table_;
  std::size_t at_ = 0;
};

}  // namespace pbnbrdf
