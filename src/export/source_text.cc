#include "export/source_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::string WithPoint(std::string text) {
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

std::string Literal(double value) { return WithPoint(FormatNumber(value)); }

std::string Literal(float value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return WithPoint(std::string(buffer, result.ptr));
}

std::string ListText(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

float SinglePrecision(double weight) {
  const float rounded = static_cast<float>(weight);
  if (!std::isfinite(rounded)) Fail("weight ", weight, " is beyond single precision");
  return rounded;
}

void CheckIdentifier(const std::string& name) {
  constexpr std::size_t kMaxLength = 64;
  const bool fits =
      !name.empty() && name.size() <= kMaxLength && IsLetter(name[0]) &&
      std::all_of(name.begin(), name.end(), [](char c) { return IsLetter(c) || IsDigit(c); });
  if (!fits) {
    Fail("name=", name, " is not a letter and at most ", kMaxLength - 1,
         " letters, digits or underscores");
  }
}

std::string CommentText(const NeuralBrdf& network) {
  std::string text = network.Description();
  const auto material = network.metadata().find("material");
  if (material != network.metadata().end()) text += "; fitted to " + material->second;
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return c < ' ' || c > '~' || c == '*' || c == '\\' || c == '?'; }, '_');
  return text;
}

std::string FillIn(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& values) {
  std::string result;
  for (std::size_t at; (at = text.find('@')) != std::string_view::npos;) {
    const std::string_view key = text.substr(at + 1, text.find('@', at + 1) - at - 1);
    const auto found = std::find_if(values.begin(), values.end(),
                                    [&](const auto& value) { return value.first == key; });
    const bool known = found != values.end();
    result += text.substr(0, known ? at : at + 1);
    if (known) result += found->second;
    text.remove_prefix(known ? at + key.size() + 2 : at + 1);
  }
  return result += text;
}

}  // namespace pbnbrdf
