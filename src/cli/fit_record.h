// fit_record.h: what a fit of a network leaves behind besides the weights: metadata and summary.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "material_options.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf::cli {

struct FitSubject {
  MaterialOptions material;
  std::string flagfile;  // the flags that repeat the fit
};

// The network with the metadata that its file is to have. measures: MeasureFit's.
NeuralBrdf WithMetadata(const Fit& fit, const FitSubject& subject,
                        const nlohmann::ordered_json& measures);

// The measures, and after them how the fit went.
nlohmann::ordered_json FitSummaryJson(const Fit& fit, const FitSubject& subject,
                                      nlohmann::ordered_json measures);

}  // namespace pbnbrdf::cli
