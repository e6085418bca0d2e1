// error.h: the one exception that this library throws.
//
// Whatever reads input (files, flags' values, problem descriptions) throws Error when the input is
// unusable; the message names the file or the field, what was found and what was expected, in one
// line. Purely numerical functions don't throw: their preconditions stand in their comments.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace pbnbrdf {

class Error : public std::runtime_error {
 public:
  // The message becomes one line: control characters, which it may quote from a damaged file, become '?'.
  explicit Error(std::string message) : std::runtime_error(OneLine(std::move(message))) {}

 private:
  static std::string OneLine(std::string message) {
    for (char& c : message) {
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    }
    return message;
  }
};

// The arguments written one after the other, as operator<< writes them.
template <typename... Parts>
std::string StrCat(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

template <typename... Parts>
[[noreturn]] void Fail(const Parts&... parts) {
  throw Error(StrCat(parts...));
}

}  // namespace pbnbrdf
