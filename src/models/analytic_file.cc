// Analytic models as JSON.
#include <nlohmann/json.hpp>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

using nlohmann::ordered_json;

constexpr std::uintmax_t kMaxFileSize = 1 << 20;

std::vector<double> NumbersOf(const std::string& name, const ordered_json& value) {
  std::vector<double> numbers;
  for (const ordered_json& number : value.is_array() ? value : ordered_json::array({value})) {
    if (!number.is_number()) Fail("parameter ", name, ": expected a number or three");
    numbers.push_back(number.get<double>());
  }
  return numbers;
}

AnalyticBrdf FromJson(const ordered_json& json) {
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
  const ordered_json json = ordered_json::parse(ReadFile(path, kMaxFileSize), nullptr,
                                                /*allow_exceptions=*/false);
  try {
    if (json.is_discarded()) Fail("not a JSON file");
    AnalyticBrdf brdf = FromJson(json);
    for (const auto& [key, value] : json.items()) {
      if (key == "model" || key == "parameters") continue;
      brdf.metadata_[key] = value.is_string() ? value.get<std::string>() : value.dump();
    }
    return brdf;
  } catch (const Error& error) {
    Fail(path, ": ", error.what());
  } catch (const nlohmann::json::exception& error) {
    Fail(path, ": ", error.what());  // texts that aren't UTF-8
  }
}

std::string AnalyticBrdf::Json() const {
  ordered_json parameters;
  for (const auto& [name, values] : NamedValues()) {
    if (values.size() == 1) {
      parameters[name] = values[0];
    } else {
      parameters[name] = values;
    }
  }
  return ordered_json{{"model", model_->name}, {"parameters", parameters}}.dump();
}

}  // namespace pbnbrdf
