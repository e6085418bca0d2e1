// json.h: JSON texts in and out. A file that parses or prints JSON itself takes seconds more to compile.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace pbnbrdf {

using Json = nlohmann::ordered_json;

// A discarded value if the text isn't JSON.
Json ParseJson(std::string_view text);

// In one line, and as a file has it: indented, with a newline at the end. Bytes that aren't UTF-8 are replaced.
std::string JsonLine(const Json& json);
std::string JsonText(const Json& json);

}  // namespace pbnbrdf
