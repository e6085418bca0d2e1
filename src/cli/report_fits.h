// report_fits.h: writes the page that `report` is about.
#pragma once

#include <string>

#include "report_subjects.h"

namespace pbnbrdf::cli {

struct ReportRequest {
  ReportOptions which;
  std::string out;                 // HTML file
  std::string scene, environment;  // "": a sphere under a sky; that of the scene
  int film_width = 0;              // 0: what suits the number of fits
  int samples_per_pixel = 64, threads = 0;
  bool quiet = false;
};

// Of a folder's fits the measures are those of their summaries, where they are of this version; else they are
// measured. Throws UsageError and Error; then nothing is written.
void WriteReport(const ReportRequest& request);

}  // namespace pbnbrdf::cli
