// names.h: one table per enumeration feeds the parser, the error text and the help.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "pbnbrdf/base/error.h"

namespace pbnbrdf {

template <typename Enum, std::size_t N>
using NameTable = std::array<std::pair<std::string_view, Enum>, N>;

// "a | b | c"
template <typename Enum, std::size_t N>
std::string JoinNames(const NameTable<Enum, N>& table) {
  std::string joined;
  for (const auto& [name, value] : table) {
    joined += (joined.empty() ? "" : " | ") + std::string(name);
  }
  return joined;
}

// Throws Error: "<field>=<name> is not one of a | b | c".
template <typename Enum, std::size_t N>
Enum ParseName(const NameTable<Enum, N>& table, std::string_view field, std::string_view name) {
  for (const auto& [known, value] : table) {
    if (known == name) return value;
  }
  Fail(field, "=", name, " is not one of ", JoinNames(table));
}

// The one of a range's elements whose `name` this is. Throws Error: "<before><name> is not one of a | b | c".
template <typename Range>
const auto& FindNamed(const Range& range, std::string_view before, std::string_view name) {
  std::string names;
  for (const auto& element : range) {
    if (element.name == name) return element;
    names += (names.empty() ? "" : " | ") + std::string(element.name);
  }
  Fail(before, name, " is not one of ", names);
}

// The value must be in the table.
template <typename Enum, std::size_t N>
std::string_view NameOf(const NameTable<Enum, N>& table, Enum value) {
  for (const auto& [name, known] : table) {
    if (known == value) return name;
  }
  return "?";
}

}  // namespace pbnbrdf
