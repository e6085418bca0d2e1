// measures.h: what is measured of a fit against its material.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/json.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/metrics/coverage.h"
#include "pbnbrdf/network/network_shape.h"

namespace pbnbrdf {

// The held-out samples that errors are measured at: the same ones by default in every command, so that `fit`
// and `measure` report the same numbers for the same fit. The standard error of a mean over 200,000 is about
// 1 % of it even where the standard deviation is five times the mean.
struct MeasureOptions {
  std::uint64_t samples = 200000;
  std::uint64_t seed = 1;
  // About what it may take, besides SecondsOfChecks. Else there are fewer samples, and no albedos of the material.
  double seconds = std::numeric_limits<double>::infinity();
  std::vector<IncidentAlbedo> profile = {};  // EnergySummary::profile, where it is known
};

// About what MeasureFit takes for a network's own energy and reciprocity.
double SecondsOfChecks(const NetworkShape& shape);

// The keys are those of MeasuresText, in its order. parameters: numbers that the fit stores.
Json MeasureFit(const Brdf& material, const Brdf& fit, std::size_t parameters,
                const MeasureOptions& options = {});

// What to beware of in a material, a sentence each: only a plane was measured, or values look like those of
// another unit.
std::vector<std::string> Cautions(const Coverage& coverage);

// What a measure is: its unit, and what it means.
struct MeasureMeaning {
  const char* key;
  const char* meaning;
};

// Of the measures that people read, in the order in which they are shown.
std::span<const MeasureMeaning> MeasureMeanings();

// A line for each key, with its unit and meaning, and for each of its "cautions".
std::string MeasuresText(const Json& measures);

}  // namespace pbnbrdf
