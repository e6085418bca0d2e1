#include "report/page.h"

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "chart_text.h"
#include "main_text.h"
#include "page_text.h"
#include "pbnbrdf/base/error.h"
#include "plots_text.h"
#include "sphere_text.h"
#include "style_text.h"
#include "summary_text.h"

namespace pbnbrdf {
namespace {

Json LightsJson(const std::vector<DistantLight>& lights) {
  Json json = Json::array();
  for (const DistantLight& light : lights) {
    json.push_back({{"direction", {light.direction.x, light.direction.y, light.direction.z}},
                    {"irradiance", light.irradiance}});
  }
  return json;
}

// JSON that can stand in a script element: what looks like the end of one is written as an escape.
std::string ScriptText(const Json& json) {
  std::string text;
  for (const char c : JsonLine(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

// `text` with each "{{name}}" replaced, in order.
std::string Assembled(
    std::string_view text,
    const std::vector<std::pair<std::string_view, std::string_view>>& replacements) {
  std::string page;
  for (const auto& [name, content] : replacements) {
    const std::size_t at = text.find(name);
    page += text.substr(0, at);
    page += content;
    text.remove_prefix(at + name.size());
  }
  return page += text;
}

}  // namespace

std::string ReportPage(const std::vector<Json>& reports, const std::vector<DistantLight>& lights,
                       const std::string& version) {
  const Json data = {{"version", version}, {"lights", LightsJson(lights)}, {"materials", reports}};
  const std::string script =
      StrCat("'use strict';\n", kSummaryText, kPlotsText, kSphereText, kMainText);
  return Assembled(kPageText, {{"{{style}}", kStyleText},
                               {"{{data}}", ScriptText(data)},
                               {"{{chart}}", kChartText},
                               {"{{script}}", script}});
}

}  // namespace pbnbrdf
