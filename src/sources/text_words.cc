#include "sources/text_words.h"

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

bool TextWords::Next() {
  ++at_;
  while (at_ >= table_.cells().size() || table_.cells()[at_].starts_with("#")) {
    if (!table_.Next()) return false;
    at_ = 0;
  }
  return true;
}

std::string_view TextWords::NextWord(std::string_view what) {
  if (!Next()) FailTruncated(what);
  return word();
}

double TextWords::NextNumber(std::string_view what) {
  NextWord(what);
  return Number();
}

std::vector<double> TextWords::NextNumbers(std::size_t count, std::string_view what) {
  std::vector<double> numbers;
  while (numbers.size() < count) numbers.push_back(NextNumber(what));
  return numbers;
}

std::size_t TextWords::NextCount(std::size_t most, std::string_view what) {
  const long count = ParseInteger(StrCat(Place(), ", ", what), NextWord(what));
  if (count < 1 || static_cast<std::size_t>(count) > most) {
    Fail(Place(), ": ", what, ": ", count, "; must be 1 to ", most);
  }
  return static_cast<std::size_t>(count);
}

void TextWords::FailTruncated(std::string_view what) const {
  Fail(table_.path(), ": ends before ", what, "; is the file truncated?");
}

}  // namespace pbnbrdf
