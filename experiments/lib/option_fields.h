// option_fields.h: kinds of fields (base/fields.h) that only programs of experiments/ have.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"
#include "base/text.h"

namespace pbnbrdf {

// "a,b,c"
Field Texts(std::string name, std::vector<std::string>* values, std::string help);

// Sizes of the hidden layers of several networks: "21,21 32,32". "" is no network.
Field Networks(std::string name, std::vector<std::vector<int>>* networks, std::string help);

// "1,2,3" with "," for the separator.
std::string Joined(const std::vector<int>& values, const std::string& separator);

// "21-21"
std::string HiddenName(const std::vector<int>& hidden);

// What a problem file says, unless a number takes its place. Integer is int or std::uint64_t.
template <typename Integer>
Field OverridingInteger(const std::string& name, std::optional<Integer>* value, Range range,
                        const std::string& help) {
  return Custom(
      name,
      [=](std::string_view text) {
        *value = text == "auto" ? std::nullopt : std::optional(ParseInteger<Integer>(name, text));
      },
      [=] { return *value ? StrCat(**value) : std::string("auto"); },
      [=] {
        if (*value && !range.Holds(static_cast<double>(**value))) {
          Fail(name, " = ", **value, "; must be ", range.Text());
        }
      },
      help + "; auto: as the problem says");
}

}  // namespace pbnbrdf
