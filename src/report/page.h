// page.h: reports of fits as one HTML file that needs nothing else: it opens offline.
#pragma once

#include <string>
#include <vector>

#include "base/json.h"
#include "report/light_set.h"

namespace pbnbrdf {

// reports: MaterialReport's, at least one. lights: of the scene that the pictures show.
std::string ReportPage(const std::vector<Json>& reports, const std::vector<DistantLight>& lights,
                       const std::string& version);

}  // namespace pbnbrdf
