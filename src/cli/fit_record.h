// fit_record.h: what a fit leaves behind besides its weights: metadata and summary.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/solve/fit.h"

namespace pbnbrdf::cli {

struct FitSubject {
  std::string material;  // its source
  double scale_to_albedo;
  std::string problem;  // a flagfile
};

// For the network's file. measures: MeasureFit's.
NeuralBrdf::Metadata FitMetadata(const FitSubject& subject, const FitProblem& problem,
                                 const FitSummary& summary, const nlohmann::ordered_json& measures);

// The measures, and after them how the fit went.
nlohmann::ordered_json FitSummaryJson(const FitSubject& subject, const FitProblem& problem,
                                      const FitSummary& summary, nlohmann::ordered_json measures);

// As a file has it: indented, whatever bytes its texts have.
std::string JsonText(const nlohmann::ordered_json& json);

}  // namespace pbnbrdf::cli
