// Analytic models as JSON.
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

constexpr std::uintmax_t kMaxFileSize = 1 << 20;

std::vector<double> NumbersOf(const std::string& name, const Json& value) {
  std::vector<double> numbers;
  for (const Json& number : value.is_array() ? value : Json::array({value})) {
    if (!number.is_number()) Fail("parameter ", name, ": expected a number or three");
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

AnalyticBrdf FromJson(const Json& json) {
  if (!json.is_object() || !json.contains("model") || !json.at("model").is_string() ||
      !json.contains("parameters") || !json.at("parameters").is_object()) {
    Fail("not an analytic model: expected a JSON object with \"model\" and \"parameters\"");
  }
  AnalyticBrdf::Values values;
  for (const auto& [name, value] : json.at("parameters").items()) {
    values[name] = NumbersOf(name, value);
  }
  return AnalyticBrdf::FromValues(json.at("model").get<std::string>(), values);
}

}  // namespace

AnalyticBrdf AnalyticBrdf::Read(const std::string& path) {
  const pbnbrdf::Json json = ParseJson(ReadFile(path, kMaxFileSize));
  try {
    if (json.is_discarded()) Fail("not a JSON file");
    AnalyticBrdf brdf = FromJson(json);
    for (const auto& [key, value] : json.items()) {
      if (key == "model" || key == "parameters") continue;
      brdf.metadata_[key] = value.is_string() ? value.get<std::string>() : JsonLine(value);
    }
    return brdf;
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  }
}

std::string AnalyticBrdf::Json() const {
  pbnbrdf::Json parameters;
  for (const auto& [name, values] : NamedValues()) {
    if (values.size() == 1) {
      parameters[name] = values[0];
    } else {
      parameters[name] = values;
    }
  }
  return JsonLine({{"model", model_->name}, {"parameters", parameters}});
}

}  // namespace pbnbrdf
