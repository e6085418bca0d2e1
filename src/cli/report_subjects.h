// report_subjects.h: which fits a report is about, and of which materials.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json.h"
#include "material_options.h"

namespace pbnbrdf::cli {

struct ReportOptions {
  std::string fit, fits;     // a file, or a folder
  MaterialOptions material;  // source "": the one that the fit's file names
  std::string summary;       // of the fit
  bool any_material = false;
};

struct FitOfMaterial {
  std::string name, file;
  MaterialOptions material;
  std::string command;  // that repeats the fit; "": its file doesn't say
  Json summary;         // that fit wrote; null if there is none
};

// The fit, or those in the folder, by name. Throws UsageError if not exactly one of them is given, Error if there is
// no fit, if its file names no material and none is given, or if it names another one than is given.
std::vector<FitOfMaterial> FindFits(const ReportOptions& options);

}  // namespace pbnbrdf::cli
