#include "fit_model.h"

#include <gflags/gflags.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "fit_flags.h"
#include "fit_record.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/models/fit_analytic.h"
#include "pbnbrdf/problem/sampling.h"
#include "report.h"
#include "shared_flags.h"

DEFINE_string(model, "",
              "fit this analytic model instead of a network: lambert | oren_nayar | phong | "
              "blinn_phong | lafortune | ward | ward_duer | ward_bounded | cook_torrance | ggx | "
              "abc | disney; --out is a JSON file");
DEFINE_int32(lobes, 1, "lobes of the model, 1 or 2, over its diffuse part");

DECLARE_bool(quiet);
DECLARE_string(sampling);
DECLARE_string(summary);
DECLARE_string(trace);
DECLARE_uint64(samples);
DECLARE_uint64(seed);
DECLARE_double(loss_scale);
DECLARE_double(function_tolerance);
DECLARE_int32(max_iterations);
DECLARE_int32(starts);
DECLARE_int32(threads);

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kDefaultSamples = 6000;
constexpr std::size_t kMeasuredSamples = 100000;
constexpr std::uint64_t kMeasuredSeed = 1;

// Flags of networks that models have, too.
constexpr const char* kSharedFlags[] = {
    "sampling", "samples", "seed", "function_tolerance", "loss_scale", "max_iterations", "starts"};

void RefuseFlagsOfNetworks() {
  std::vector<std::string> names = ProblemFlagNames();
  names.insert(names.end(), {"summary", "trace"});
  for (const std::string& name : names) {
    const bool shared = std::count(std::begin(kSharedFlags), std::end(kSharedFlags), name) > 0;
    if (!shared && IsGiven(name)) {
      throw UsageError(StrCat("--", name, " is a flag of networks; --model doesn't take it"));
    }
  }
}

// Flags that aren't given leave a model's own defaults.
AnalyticFitOptions ParseOptions() {
  AnalyticFitOptions options;
  options.lobes = FLAGS_lobes;
  options.threads = FLAGS_threads;
  options.loss_scale = FLAGS_loss_scale;
  if (IsGiven("function_tolerance")) options.function_tolerance = FLAGS_function_tolerance;
  if (IsGiven("starts")) options.starts = FLAGS_starts;
  if (IsGiven("max_iterations")) options.max_iterations = FLAGS_max_iterations;
  options.Validate();
  return options;
}

// The model and the options. Throws UsageError.
std::pair<const AnalyticModel*, AnalyticFitOptions> ParseModelFlags() {
  try {
    return {&FindAnalyticModel(FLAGS_model), ParseOptions()};
  } catch (const Error& error) {
    throw UsageError(StrCat("--", error.what()));  // the message begins with the field
  }
}

nlohmann::ordered_json FitJson(const AnalyticFit& fit, const AnalyticFitOptions& options,
                               std::size_t samples, const nlohmann::ordered_json& errors) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(fit.brdf.Json());
  json["source"] = fit.brdf.Text();
  json["version"] = PBNBRDF_VERSION;
  json["material"] = FLAGS_material;
  json["scale_to_albedo"] = FLAGS_scale_to_albedo;
  json["lobes"] = fit.brdf.lobes();
  json["seed"] = FLAGS_seed;
  json["sampling"] = FLAGS_sampling;
  json["samples"] = samples;
  json["loss_scale"] = options.loss_scale;
  json["cost"] = fit.summary.final_cost;
  json["iterations"] = fit.summary.iterations;
  json["converged"] = fit.summary.converged;
  json["seconds"] = fit.summary.seconds;
  json["errors"] = errors;
  return json;
}

}  // namespace

FlagGroup ModelFlags() { return {"An analytic model instead of a network", {"model", "lobes"}}; }

bool FitsModel() {
  if (FLAGS_model.empty() && IsGiven("lobes")) throw UsageError("--lobes is a flag of --model");
  return !FLAGS_model.empty();
}

int RunModelFit() {
  RefuseFlagsOfNetworks();
  const auto& [model, options] = ParseModelFlags();
  if (FLAGS_out != "-" && !FLAGS_out.ends_with(".json")) {
    throw UsageError(StrCat("--out=", FLAGS_out, ": a model is written to a FILE.json"));
  }
  CheckWritable(FLAGS_out);
  const std::unique_ptr<Brdf> material = OpenMaterial();
  const std::size_t count = IsGiven("samples") ? FLAGS_samples : kDefaultSamples;
  std::vector<BrdfSample> samples;
  const AnalyticFit fit = AboutMaterial([&, model = model, &options = options] {
    samples = DrawSamples(*material, SampleSet::kTraining,
                          ParseName(kSamplings, "sampling", FLAGS_sampling), count, FLAGS_seed);
    return FitAnalytic(samples, material->IsIsotropic(), *model, options);
  });
  const nlohmann::ordered_json errors = MeasureFit(
      *material, fit.brdf, fit.brdf.parameters().size(), kMeasuredSamples, kMeasuredSeed);
  WriteFile(FLAGS_out, JsonText(FitJson(fit, options, samples.size(), errors)));
  if (!FLAGS_quiet && FLAGS_out != "-") {
    std::cout << FLAGS_out << ": " << fit.brdf.Description() << "; "
              << (fit.summary.converged ? "converged" : "stopped") << " after "
              << fit.summary.iterations << " iterations, " << fit.summary.seconds << " s\n"
              << MeasuresText(errors);
  }
  return 0;
}

}  // namespace pbnbrdf::cli
