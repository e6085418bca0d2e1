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

void CheckIdentifier(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  const bool fits =
      !name.empty() && name.size() <= kLongest && IsLetter(name[0]) &&
      std::all_of(name.begin(), name.end(), [](char c) { return IsLetter(c) || IsDigit(c); });
  if (!fits) {
    Fail("name=", name, " is not a letter and at most ", kLongest - 1,
         " letters, digits or underscores");
  }
}

std::string WithName(std::string_view text, const std::string& name) {
  std::string result;
  for (char c : text) {
    if (c == '@') {
      result += name;
    } else {
      result += c;
    }
  }
  return result;
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

std::string EncoderText(Encoding encoding, const EncoderTexts& texts) {
  const std::string_view inputs = texts.inputs[static_cast<std::size_t>(encoding)];
  if (encoding == Encoding::kCartesian || encoding == Encoding::kReciprocal) {
    return StrCat(texts.half_diff, inputs);
  }
  const bool has_rows = encoding == Encoding::kMerl || encoding == Encoding::kBilateral;
  return StrCat(texts.elementary, texts.half_diff, texts.theta_h, has_rows ? texts.row_bend : "",
                inputs);
}

float SinglePrecision(double weight) {
  const float rounded = static_cast<float>(weight);
  if (!std::isfinite(rounded)) Fail("weight ", weight, " is beyond single precision");
  return rounded;
}

}  // namespace pbnbrdf
