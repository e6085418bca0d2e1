#include "sources/text_lines.h"

#include "base/text.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

}  // namespace

TextLines::TextLines(const std::string& path) : path_(path), text_(ReadFile(path, kLargestFile)) {}

bool TextLines::Next(std::string_view* line) {
  while (at_ < text_.size()) {
    ++number_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) {
      Fail(Place(), ": the last line has no end; is the file truncated?");
    }
    *line = Trim(std::string_view(text_).substr(at_, end - at_));
    at_ = end + 1;
    if (!line->empty()) return true;
  }
  return false;
}

std::string TextLines::Place() const { return StrCat(path_, ": line ", number_); }

}  // namespace pbnbrdf
