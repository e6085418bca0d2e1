// report.h: the measures of a fit, as JSON and as text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "pbnbrdf/brdf/brdf.h"

namespace pbnbrdf::cli {

// The keys that eval --json documents, in that order. parameters: numbers that the fit stores.
nlohmann::ordered_json MeasureFit(const Brdf& material, const Brdf& fit, std::size_t parameters,
                                  std::size_t samples, std::uint64_t seed);

// A line for each key, with its unit and meaning.
std::string MeasuresText(const nlohmann::ordered_json& measures);

}  // namespace pbnbrdf::cli
