// report.h: the measures of a fit, as JSON and as text.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf::cli {

// The held-out samples that errors are measured at: the same ones by default in every command, so that `fit`
// and `measure` report the same numbers for the same fit. The standard error of a mean over 200,000 is about
// 1 % of it even where the standard deviation is five times the mean.
struct MeasureOptions {
  std::uint64_t samples = 200000;
  std::uint64_t seed = 1;
};

// The keys are those of MeasuresText, in its order. parameters: numbers that the fit stores.
nlohmann::ordered_json MeasureFit(const Brdf& material, const Brdf& fit, std::size_t parameters,
                                  const MeasureOptions& options = {});

// A line for each key, with its unit and meaning.
std::string MeasuresText(const nlohmann::ordered_json& measures);

}  // namespace pbnbrdf::cli
