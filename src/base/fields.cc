#include "base/fields.h"

#include <cmath>

#include "base/text.h"

namespace pbnbrdf {
namespace {

// A number without a largest value must be finite, too; a whole number always is.
void CheckRange(const std::string& name, double value, const Range& range, bool is_whole) {
  if (range.Holds(value)) return;
  const bool is_half_open = std::isfinite(range.min) && !std::isfinite(range.max);
  Fail(name, " = ", value, "; must be ", is_half_open && !is_whole ? "finite and " : "",
       range.Text());
}

// Value is int or std::uint64_t.
template <typename Value>
Field IntegerField(std::string name, Value* value, Range range, std::string help) {
  return Custom(
      name, [=](std::string_view text) { *value = ParseInteger<Value>(name, text); },
      [=] { return StrCat(*value); },
      [=] { CheckRange(name, static_cast<double>(*value), range, /*is_whole=*/true); },
      std::move(help));
}

}  // namespace

bool Range::Holds(double value) const {
  return std::isfinite(value) && value <= max && (open ? value > min : value >= min);
}

std::string Range::Text() const {
  if (std::isfinite(min) && std::isfinite(max)) return StrCat(min, " to ", max);
  if (std::isfinite(min)) return StrCat(open ? "> " : ">= ", min);
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
      [=] { return FormatNumber(*value); },
      [=] { CheckRange(name, *value, range, /*is_whole=*/false); }, std::move(help));
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
        for (int value : *values) CheckRange(name, value, range, /*is_whole=*/true);
      },
      std::move(help));
}

FlagText::FlagText(std::string_view text) {
  text.remove_prefix(text.starts_with("--") ? 2 : text.starts_with("-") ? 1 : 0);
  const std::size_t equals = text.find('=');
  name = text.substr(0, equals);
  if (equals != std::string_view::npos) value = text.substr(equals + 1);
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

Fields& Fields::AddRequired(Field field) {
  field.is_required = true;
  return AddCommon(std::move(field));
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

void Fields::CheckRequired() const {
  for (const Field& field : fields_) {
    if (field.is_required && field.text().empty()) Fail(field.name, " is required");
  }
}

std::string Fields::Lines() const {
  std::string lines;
  for (const Field& field : fields_) lines += StrCat("--", field.name, "=", field.text(), "\n");
  return lines;
}

std::vector<std::string> Fields::ReadFlags(const std::vector<std::string>& words) const {
  std::vector<std::string> others;
  for (auto word = words.begin(); word != words.end(); ++word) {
    if (!word->starts_with("-") || *word == "-") {
      others.push_back(*word);
      continue;
    }
    FlagText flag(*word);
    if (!flag.value && SetSwitch(flag.name)) continue;
    if (!flag.value && Find(flag.name) != nullptr) {
      if (++word == words.end()) throw UsageError(StrCat("--", flag.name, " needs a value"));
      flag.value = *word;
    }
    Set(flag.name, flag.value.value_or(""));
  }
  return others;
}

void Fields::ReadLines(std::string_view lines) const {
  for (const std::string& line : Split(lines, '\n')) {
    if (line.empty() || line.starts_with("#") || ReadFlags({line}).empty()) continue;
    throw UsageError(StrCat("'", line, "' is not a flag; flags begin with --"));
  }
}

void Fields::Set(std::string_view name, std::string_view text) const {
  const Field* field = Find(name);
  if (field == nullptr) FailUnknown(name);
  try {
    field->set(text);
  } catch (const Error& error) {
    // What is wrong with a value begins with the name.
    if (!std::string_view(error.what()).starts_with(name)) throw;
    throw UsageError(StrCat("--", error.what()));
  }
}

bool Fields::SetSwitch(std::string_view name) const {
  const auto set = [&](std::string_view of, const char* value) {
    const Field* field = Find(of);
    if (field == nullptr || !field->is_switch) return false;
    field->set(value);
    return true;
  };
  return set(name, "true") || (name.starts_with("no") && set(name.substr(2), "false"));
}

void Fields::FailUnknown(std::string_view name) const {
  if (fields_.empty()) throw UsageError(StrCat("--", name, " is not a flag"));
  std::vector<std::string> names;
  for (const Field& field : fields_) names.push_back(field.name);
  throw UsageError(StrCat("--", name, " is not a flag; did you mean --",
                          Nearest(names, std::string(name)), "?"));
}

}  // namespace pbnbrdf
