// material_report.h: what the page shows of one fit, as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json.h"
#include "pbnbrdf/brdf/brdf.h"
#include "pbnbrdf/image/image.h"
#include "report/value_table.h"

namespace pbnbrdf {

struct ReportSubject {
  std::string name, source, fit_file;
  const Brdf& material;
  const Brdf& fit;
  std::string command;  // that repeats the fit; "": not known
  Json measures;        // a list of {"key", "value", "meaning"}
  Json cautions;        // a list of sentences
  Json history;         // a list of [iteration, seconds, error]; null: not known
  // Radiance of the same scene with both.
  Image material_picture, fit_picture;
  ValueTableSize table;  // of the material, for the sphere that turns
};

// {"name", "source", "fit_file", "description", "command", "measures", "cautions", "history", "pictures", "curves",
// "sphere"}. Pictures are PNG files as data URLs. Numbers have five digits, and null stands for what isn't known.
Json MaterialReport(const ReportSubject& subject);

}  // namespace pbnbrdf
