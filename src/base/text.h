// text.h: numbers to and from text, independent of the locale, and lists.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

// What a text in UTF-8 may begin with.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// "a,b,c" -> {"a", "b", "c"}; blanks around the parts are dropped; "" -> {""}.
std::vector<std::string> Split(std::string_view text, char separator);

std::string_view Trim(std::string_view text);

// "a,b,c" with "," for the separator.
std::string Join(const std::vector<std::string>& parts, std::string_view separator);

// With small letters for the capitals of ASCII.
std::string LowerCase(std::string_view text);

// Throws Error "<field>: '<text>' is not a finite number" unless all of `text` is one.
double ParseNumber(std::string_view field, std::string_view text);

// Integer is int, long or std::uint64_t. Throws Error "<field>: '<text>' is not a whole number" unless all
// of `text` is one that fits.
template <typename Integer = long>
Integer ParseInteger(std::string_view field, std::string_view text);

// The one of `names`, which aren't empty, that differs from `name` in the fewest letters.
std::string Nearest(const std::vector<std::string>& names, const std::string& name);

// The shortest text that reads back as the same double.
std::string FormatNumber(double value);

// 17 significant digits.
std::string FormatFullPrecision(double value);

}  // namespace pbnbrdf
