// fit_analytic_fields.h: the options of FitAnalytic by name: flags, help and checks (base/fields.h).
#pragma once

#include "base/fields.h"
#include "pbnbrdf/models/fit_analytic.h"

namespace pbnbrdf {

// All but the threads.
Fields AnalyticFitFields(AnalyticFitOptions* options);

}  // namespace pbnbrdf
