// model_fit.h: an analytic model fitted to a material, and measured.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/json.h"
#include "pbnbrdf/models/fit_analytic.h"
#include "pbnbrdf/problem/fit_problem.h"

namespace pbnbrdf::cli {

// Models have a few dozen parameters at most, networks hundreds: a tenth of the samples determines them.
inline constexpr std::uint64_t kModelSamples = 6000;

struct ModelFit {
  AnalyticFit fit;
  std::size_t samples;
  // MeasureFit's; of the principled model also "sphere_flip": mean FLIP between pictures of a sphere of each under a
  // sky, if there is a renderer.
  Json errors;
};

ModelFit FitModel(const Brdf& material, const AnalyticModel& model, const SamplingOptions& sampling,
                  const AnalyticFitOptions& options);

// MeasuresText, and a line for FLIP where it was measured.
std::string ErrorsText(const Json& errors);

// The principled model that is nearest to the material, with the material's name and the errors as its metadata.
AnalyticBrdf PrincipledFit(const Brdf& material, const std::string& name, Json* errors);

}  // namespace pbnbrdf::cli
