#include "base/json.h"

#include <nlohmann/json.hpp>

namespace pbnbrdf {
namespace {

std::string Print(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Json ParseJson(std::string_view text) {
  return Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

std::string JsonLine(const Json& json) { return Print(json, -1); }

std::string JsonText(const Json& json) { return Print(json, 2) + "\n"; }

}  // namespace pbnbrdf
