#include "base/fields.h"

#include <cmath>
#include <sstream>

#include "base/text.h"
#include "pbnbrdf/base/error.h"

namespace pbnbrdf {
namespace {

void CheckRange(const std::string& name, double value, const Range& range) {
  if (!range.Holds(value)) Fail(name, " = ", value, "; must be ", range.Text());
}

// Value is int or std::uint64_t.
template <typename Value>
Field IntegerField(std::string name, Value* value, Range range, std::string help) {
  return Custom(
      name, [=](std::string_view text) { *value = ParseInteger<Value>(name, text); },
      [=] { return StrCat(*value); }, [=] { CheckRange(name, static_cast<double>(*value), range); },
      std::move(help));
}

}  // namespace

bool Range::Holds(double value) const {
  return std::isfinite(value) && value <= max && (open ? value > min : value >= min);
}

std::string Range::Text() const {
  if (std::isfinite(min) && std::isfinite(max)) return StrCat(min, " to ", max);
  if (std::isfinite(min)) return StrCat("finite and ", open ? "> " : ">= ", min);
  return "finite";
}

Field Custom(std::string name, std::function<void(std::string_view)> parse,
             std::function<std::string()> print, std::function<void()> check, std::string help) {
  Field field;
  field.name = std::move(name);
  field.help = std::move(help);
  field.default_text = print();
  field.set = std::move(parse);
  field.text = std::move(print);
  field.check = std::move(check);
  return field;
}

Field Number(std::string name, double* value, Range range, std::string help) {
  return Custom(
      name, [=](std::string_view text) { *value = ParseNumber(name, text); },
      [=] { return FormatNumber(*value); }, [=] { CheckRange(name, *value, range); },
      std::move(help));
}

Field Integer(std::string name, int* value, Range range, std::string help) {
  return IntegerField(std::move(name), value, range, std::move(help));
}

Field Integer(std::string name, std::uint64_t* value, Range range, std::string help) {
  return IntegerField(std::move(name), value, range, std::move(help));
}

Field Switch(std::string name, bool* value, std::string help) {
  Field field = Custom(
      name,
      [=](std::string_view text) {
        if (text != "true" && text != "false") Fail(name, "=", text, " is not true | false");
        *value = text == "true";
      },
      [=] { return *value ? "true" : "false"; }, [] {}, std::move(help));
  field.is_switch = true;
  return field;
}

Field Text(std::string name, std::string* value, std::string help) {
  return Custom(
      std::move(name), [=](std::string_view text) { *value = text; }, [=] { return *value; }, [] {},
      std::move(help));
}

Field Integers(std::string name, std::vector<int>* values, Range range, std::string help) {
  return Custom(
      name,
      [=](std::string_view text) {
        std::vector<int> parsed;
        for (const std::string& part : Split(text, ',')) {
          parsed.push_back(ParseInteger<int>(name, part));
        }
        *values = parsed;
      },
      [=] {
        std::string text;
        for (int value : *values) text += StrCat(text.empty() ? "" : ",", value);
        return text;
      },
      [=] {
        for (int value : *values) CheckRange(name, value, range);
      },
      std::move(help));
}

Fields& Fields::Add(Field field) {
  field.group = group_;
  fields_.push_back(std::move(field));
  return *this;
}

Fields& Fields::AddCommon(Field field) {
  field.is_common = true;
  return Add(std::move(field));
}

Fields& Fields::Add(const Fields& others) {
  fields_.insert(fields_.end(), others.fields_.begin(), others.fields_.end());
  return *this;
}

const Field* Fields::Find(std::string_view name) const {
  for (const Field& field : fields_) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

void Fields::Check() const {
  for (const Field& field : fields_) field.check();
}

std::string Fields::Lines() const {
  std::string lines;
  for (const Field& field : fields_) lines += StrCat("--", field.name, "=", field.text(), "\n");
  return lines;
}

void Fields::ReadLines(std::string_view lines) const {
  std::istringstream in{std::string(lines)};
  for (std::string line; std::getline(in, line);) {
    const std::string_view text = Trim(line);
    if (text.empty() || text.starts_with("#")) continue;
    if (!text.starts_with("--")) Fail("'", text, "' is not a flag; flags begin with --");
    const std::string_view flag = text.substr(2);
    const std::size_t equals = flag.find('=');
    if (equals != std::string_view::npos) {
      Set(flag.substr(0, equals), flag.substr(equals + 1));
    } else if (const Field* field = Find(flag); field != nullptr && field->is_switch) {
      field->set("true");
    } else if (const Field* negated = flag.starts_with("no") ? Find(flag.substr(2)) : nullptr;
               negated != nullptr && negated->is_switch) {
      negated->set("false");
    } else {
      Fail("--", flag, " needs a value");
    }
  }
}

void Fields::Set(std::string_view name, std::string_view text) const {
  if (const Field* field = Find(name)) return field->set(text);
  std::vector<std::string> names;
  for (const Field& field : fields_) names.push_back(field.name);
  Fail("--", name, " is unknown; did you mean --", Nearest(names, std::string(name)), "?");
}

}  // namespace pbnbrdf
