// paper_tables.h: the paper's Tables 1 to 3 from what each method reaches on each material.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/metrics/image_metrics.h"

namespace pbnbrdf {

inline constexpr char kItself[] = "material itself", kPublishedNetwork[] = "published network",
                      kRecipe[] = "NBRDF's recipe", kOurs[] = "ours";

struct PaperRecord {
  std::string material, method;
  bool low_dissipation = false;  // of the material: Table 2 is about these
  double log_error = 0.0;        // eq. 6, held-out
  Reciprocity reciprocity;
  Energy energy;
  ImageErrors picture;  // against the material's own; not of kItself
  // Of that picture, where it was measured.
  double lpips = std::numeric_limits<double>::quiet_NaN();
};

// A row for each method, in the order in which they first appear; of each column the median over materials and the
// worst. Below each table ours against each other method on the materials that both have, and where ours loses. The
// paper's own figures stand apart, labelled as printed.
std::string PaperMarkdown(const std::vector<PaperRecord>& records);

// All numbers, a row for each record.
std::string PaperCsv(const std::vector<PaperRecord>& records);

}  // namespace pbnbrdf
