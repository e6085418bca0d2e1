// fields.h: a table of the fields of a struct, from which its flags, their help, the checks of its values
// and the text that records them all come: one line adds a field.
//
//   Fields FieldsOf(Schedule* s) {
//     Fields fields;
//     fields.Group("The schedule");
//     fields.Add(Number("growth", &s->growth, Above(1.0), "factor of samples each time ..."));
//     return fields;
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/base/names.h"

namespace pbnbrdf {

// What a number may be: from min to max, or above min where it is `open`; always finite.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool open = false;

  // False for what isn't finite.
  bool Holds(double value) const;
  // "> 0", ">= 1", "1 to 1024"; "finite" if there are no bounds.
  std::string Text() const;
};

inline Range Any() { return {}; }
inline Range AtLeast(double min) { return {.min = min}; }
inline Range Above(double min) { return {.min = min, .open = true}; }
inline Range Between(double min, double max) { return {.min = min, .max = max}; }

// One field of one object, which must outlive it. Errors are Errors that begin with the name.
struct Field {
  std::string name, help;
  std::string default_text;          // the value of the object when the field was made
  bool is_switch = false;            // of type bool
  bool is_common = false;            // --help shows it, not only --help=all
  bool is_required = false;          // its text must not be empty
  std::string group;                 // the heading that it stands under
  std::vector<std::string> choices;  // all that the text may be; none: anything

  std::function<void(std::string_view text)> set;  // throws Error if the text is no value of it
  std::function<std::string()> text;               // of the value; set() reads it back exactly
  std::function<void()> check;                     // throws Error if the value is out of range
};

Field Number(std::string name, double* value, Range range, std::string help);
Field Integer(std::string name, int* value, Range range, std::string help);
Field Integer(std::string name, std::uint64_t* value, Range range, std::string help);
Field Switch(std::string name, bool* value, std::string help);
Field Text(std::string name, std::string* value, std::string help);

// "a,b,c"
Field Integers(std::string name, std::vector<int>* values, Range range, std::string help);

// A field whose text is something else: parse throws Error, print gives what parse reads back, check
// throws Error if the value is out of range.
Field Custom(std::string name, std::function<void(std::string_view)> parse,
             std::function<std::string()> print, std::function<void()> check, std::string help);

// One of the names of a table. The help ends with them.
template <typename Enum, std::size_t N>
Field Choice(std::string name, Enum* value, const NameTable<Enum, N>& table,
             const std::string& help) {
  Field field = Custom(
      name, [name, value, &table](std::string_view text) { *value = ParseName(table, name, text); },
      [value, &table] { return std::string(NameOf(table, *value)); }, [] {},
      help + " (" + JoinNames(table) + ")");
  for (const auto& [choice, _] : table) field.choices.emplace_back(choice);
  return field;
}

// The same, or "auto", which stands for no value.
template <typename Enum, std::size_t N>
Field ChoiceOrAuto(std::string name, std::optional<Enum>* value, const NameTable<Enum, N>& table,
                   const std::string& help) {
  Field field = Custom(
      name,
      [name, value, &table](std::string_view text) {
        NameTable<std::optional<Enum>, N + 1> names = {{{"auto", std::nullopt}}};
        for (std::size_t i = 0; i < N; ++i) names[i + 1] = {table[i].first, table[i].second};
        *value = ParseName(names, name, text);
      },
      [value, &table] { return *value ? std::string(NameOf(table, **value)) : "auto"; }, [] {},
      help + " (auto | " + JoinNames(table) + ")");
  field.choices = {"auto"};
  for (const auto& [choice, _] : table) field.choices.emplace_back(choice);
  return field;
}

// A flag isn't one, has no value, or has one that can't be.
class UsageError : public Error {
 public:
  using Error::Error;
};

// "--name=value" or "--name", with one dash or two, in its parts.
struct FlagText {
  explicit FlagText(std::string_view text);

  std::string name;
  std::optional<std::string> value;
};

class Fields {
 public:
  // The heading of the fields that are added next.
  void Group(std::string title) { group_ = std::move(title); }

  Fields& Add(Field field);
  // The same, but --help shows it; the same, but it must also be given.
  Fields& AddCommon(Field field);
  Fields& AddRequired(Field field);
  // Those of another table, under their own headings.
  Fields& Add(const Fields& others);

  const std::vector<Field>& all() const { return fields_; }

  // Null if there is none of that name.
  const Field* Find(std::string_view name) const;

  // Throws Error "NAME = VALUE; must be ..." for the first value that is out of range.
  void Check() const;

  // Throws Error "NAME is required" for the first required field whose text is empty.
  void CheckRequired() const;

  // "--name=value" for each field, a line each: read back by ReadLines.
  std::string Lines() const;

  // Sets the fields that the flags among the words name: "--name=value", "--name value", and of switches
  // "--name" and "--noname", with one dash or two; later ones replace earlier ones. Returns the other
  // words. Throws UsageError.
  std::vector<std::string> ReadFlags(const std::vector<std::string>& words) const;

  // The same of lines that are a flag each; empty ones and those that begin with # are comments.
  void ReadLines(std::string_view lines) const;

  // Sets one field. Throws UsageError: "--NAME: 'VALUE' is not ...", or that there is none of the name, with
  // the nearest that there is.
  void Set(std::string_view name, std::string_view text) const;

 private:
  bool SetSwitch(std::string_view name) const;
  [[noreturn]] void FailUnknown(std::string_view name) const;

  std::string group_;
  std::vector<Field> fields_;
};

}  // namespace pbnbrdf
