// fit_record.h: what a fit leaves behind besides its weights: metadata and summary.
#pragma once

#include <string>

#include "command_line.h"
#include "material_options.h"
#include "measure/measures.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf::cli {

struct FitSubject {
  MaterialOptions material;
  std::string flagfile;          // the flags that repeat the fit
  std::string fingerprint = {};  // of all that the fit depends on; "": not recorded
};

// The network with the metadata that its file is to have. measures: MeasureFit's.
NeuralBrdf WithMetadata(const Fit& fit, const FitSubject& subject, const Json& measures);

// The measures, and after them how the fit went.
Json FitSummaryJson(const Fit& fit, const FitSubject& subject, Json measures);

}  // namespace pbnbrdf::cli
