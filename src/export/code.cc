#include "export/code.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

using Kind = Term::Kind;
using Vector = std::array<Term, 3>;

// Which operator of an expression binds last, from the loosest to none: an atom never needs parentheses.
enum class Binding { kTernary, kSum, kProduct, kAtom };

struct Text {
  std::string text;
  Binding binding;

  // In parentheses if it is looser than `min`.
  std::string Bound(Binding min) const { return binding < min ? "(" + text + ")" : text; }
};

std::string Fill(std::string_view pattern, const std::vector<std::string>& operands) {
  std::string text;
  auto next = operands.begin();
  for (char c : pattern) text += c == '$' ? *next++ : std::string(1, c);
  return text;
}

class Printer {
 public:
  explicit Printer(const Language& language) : language_(language) {}

  void CountUses(const Term& term) {
    if (++uses_[&term.node()] > 1) return;
    for (const Term& operand : term.node().operands) CountUses(operand);
  }

  // Prints the statements that it needs.
  Text Value(const Term& term) {
    const Term::Node& node = term.node();
    if (node.kind == Kind::kVariable) return {node.name, Binding::kAtom};
    if (node.kind == Kind::kConstant) return {Constant(node.constant), Binding::kAtom};
    const auto known = names_.find(&node);
    if (known != names_.end()) return {known->second, Binding::kAtom};
    const Text text = Operation(node);
    if (uses_[&node] == 1 && node.name.empty()) return text;
    const std::string name = node.name.empty() ? StrCat("t", ++unnamed_) : node.name;
    statements_ += Fill(language_.statement, {name, text.text});
    return {names_[&node] = name, Binding::kAtom};
  }

  const std::string& statements() const { return statements_; }

 private:
  std::string Constant(double value) const {
    return language_.single_precision ? Literal(static_cast<float>(value)) : Literal(value);
  }

  Text Operation(const Term::Node& node) {
    std::vector<Text> operands;
    for (const Term& operand : node.operands) operands.push_back(Value(operand));
    if (node.kind < Kind::kMax) {
      // Sums and products associate to the left in all languages, and rounding goes by that.
      const bool is_sum = node.kind < Kind::kMultiply;
      const Binding left = is_sum ? Binding::kSum : Binding::kProduct;
      const Binding right = is_sum ? Binding::kProduct : Binding::kAtom;
      const char symbol = "+-*/"[static_cast<int>(node.kind)];
      return {StrCat(operands[0].Bound(left), " ", symbol, " ", operands[1].Bound(right)), left};
    }
    constexpr int kFirst = static_cast<int>(Kind::kMax);
    const std::string_view pattern = language_.functions[static_cast<int>(node.kind) - kFirst];
    const bool is_if = node.kind == Kind::kIfGreater;
    std::vector<std::string> texts;
    for (const Text& text : operands) {
      texts.push_back(text.Bound(is_if ? Binding::kSum : Binding::kTernary));
    }
    return {Fill(pattern, texts), pattern.ends_with(')') ? Binding::kAtom : Binding::kTernary};
  }

  const Language& language_;
  std::map<const Term::Node*, int> uses_;
  std::map<const Term::Node*, std::string> names_;
  std::string statements_;
  int unnamed_ = 0;
};

Vector Components(const Language& language, const std::string& vector) {
  const auto component = [&](int i) {
    return Term::Variable(StrCat(vector, language.component[i]));
  };
  return {component(0), component(1), component(2)};
}

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::string WithPoint(std::string text) {
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace

Code PrintTerms(const Language& language, const std::vector<Term>& terms) {
  Printer printer(language);
  for (const Term& term : terms) printer.CountUses(term);
  Code code;
  for (const Term& term : terms) code.values.push_back(printer.Value(term).text);
  code.statements = printer.statements();
  return code;
}

std::string PrintExpression(const Language& language, const Term& term) {
  const Code code = PrintTerms(language, {term});
  if (!code.statements.empty()) Fail("an expression needs statements: ", code.statements);
  return code.values[0];
}

Code PrintInputs(const Language& language, Encoding encoding) {
  const Vector wi = Components(language, "wi"), wo = Components(language, "wo");
  Vector sum = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
  HalfDiffOf<Term> v = HalfDiffFromSum<Term>(sum, {wi[0] - wo[0], wi[1] - wo[1], wi[2] - wo[2]});
  const std::array terms = {&sum[0],    &sum[1],    &sum[2], &v.sin_theta, &v.cos_theta,
                            &v.sin_phi, &v.cos_phi, &v.dx,   &v.dy,        &v.dz};
  const std::array names = {"sum_x",     "sum_y",     "sum_z", "sin_theta_h", "cos_theta_h",
                            "sin_phi_h", "cos_phi_h", "dx",    "dy",          "dz"};
  for (std::size_t i = 0; i < terms.size(); ++i) terms[i]->SetName(names[i]);
  const Inputs<Term> inputs = Encode(encoding, v);
  return PrintTerms(language, {inputs.begin(), inputs.end()});
}

std::string Literal(double value) { return WithPoint(FormatNumber(value)); }

std::string Literal(float value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return WithPoint(std::string(buffer, result.ptr));
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
  const auto half = network.metadata().find("half_precision");
  if (half != network.metadata().end()) text += "; weights of half precision: " + half->second;
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
