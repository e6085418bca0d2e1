// pbnbrdf fit-model
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "command_line.h"
#include "fit_record.h"
#include "material_options.h"
#include "models/fit_analytic_fields.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/problem/fit_problem.h"
#include "problem/problem_fields.h"

namespace pbnbrdf::cli {
namespace {

// Models have a few dozen parameters at most, networks hundreds: a tenth of the samples determines them.
constexpr std::uint64_t kModelSamples = 6000;

struct FitModelOptions {
  FitModelOptions() { sampling.samples = kModelSamples; }

  MaterialOptions material;
  std::string model;
  std::string out;
  bool quiet = false;
  SamplingOptions sampling;
  AnalyticFitOptions fit;
};

Field ModelField(std::string* model) {
  std::string names;
  for (const AnalyticModel& known : AnalyticModels()) {
    names += StrCat(names.empty() ? "" : " | ", known.name);
  }
  return Custom(
      "model", [=](std::string_view text) { *model = FindAnalyticModel(text).name; },
      [=] { return *model; }, [] {}, "the model: " + names);
}

Fields SubjectFields(FitModelOptions* options) {
  Fields fields;
  fields.Group("The material and the model");
  fields.AddRequired(MaterialField(&options->material));
  fields.Add(ScaleField(&options->material));
  fields.AddRequired(ModelField(&options->model));
  return fields;
}

// With those of the subject all that it takes to repeat the fit.
Fields SolutionFields(FitModelOptions* options) {
  return Fields().Add(SamplingFields(&options->sampling)).Add(AnalyticFitFields(&options->fit));
}

Fields FitModelFields(FitModelOptions* options) {
  Fields fields = SubjectFields(options);
  fields.AddRequired(Text("out", &options->out, "file for the model, FILE.json"));
  fields.AddCommon(Switch("quiet", &options->quiet, "print nothing"));
  fields.Add(Integer("threads", &options->fit.threads, AtLeast(0),
                     "threads to use; 0: one for each core"));
  return fields.Add(SolutionFields(options));
}

Json FitJson(const FitModelOptions& options, const AnalyticFit& fit, std::size_t samples,
             const Json& errors) {
  FitModelOptions copy = options;
  Json json = ParseJson(fit.brdf.Json());
  json["source"] = fit.brdf.Text();
  json["version"] = PBNBRDF_VERSION;
  json["material"] = options.material.source;
  json["scale_to_albedo"] = options.material.scale_to_albedo;
  json["lobes"] = fit.brdf.lobes();
  json["seed"] = options.sampling.seed;
  json["sampling"] = NameOf(kSamplings, options.sampling.angles);
  json["samples"] = samples;
  json["loss_scale"] = options.fit.loss_scale;
  json["cost"] = fit.summary.final_cost;
  json["iterations"] = fit.summary.iterations;
  json["converged"] = fit.summary.converged;
  json["seconds"] = fit.summary.seconds;
  json["problem"] = SubjectFields(&copy).Lines() + SolutionFields(&copy).Lines();
  json["errors"] = errors;
  return json;
}

int RunFitModel(const FitModelOptions& options, const Arguments&) {
  if (options.out != "-" && !options.out.ends_with(".json")) {
    throw UsageError(StrCat("--out=", options.out, ": a model is written to a FILE.json"));
  }
  CheckOutputs({{"out", options.out}});
  const std::unique_ptr<Brdf> material = options.material.Open();
  std::vector<BrdfSample> samples;
  const AnalyticFit fit = About(options.material.source, [&] {
    samples = DrawSamples(*material, SampleSet::kTraining, options.sampling.angles,
                          options.sampling.samples, options.sampling.seed);
    return FitAnalytic(samples, material->IsIsotropic(), FindAnalyticModel(options.model),
                       options.fit);
  });
  const Json errors = MeasureFit(*material, fit.brdf, fit.brdf.parameters().size());
  WriteFile(options.out, JsonText(FitJson(options, fit, samples.size(), errors)));
  if (!options.quiet && options.out != "-") {
    std::cout << options.out << ": " << fit.brdf.Description() << "; "
              << (fit.summary.converged ? "converged" : "stopped") << " after "
              << fit.summary.iterations << " iterations, " << fit.summary.seconds << " s\n"
              << MeasuresText(errors);
  }
  return 0;
}

}  // namespace

Command FitModelCommand() {
  return Command{.name = "fit-model",
                 .summary = "fits an analytic model to a material, to compare networks with",
                 .usage = R"(  pbnbrdf fit-model --model=ggx --material=gold.binary --out=gold.json
  pbnbrdf fit-model --model=ggx --lobes=2 --material=gold.binary --out=gold.json
)",
                 .notes = StrCat(kSourceNotes, R"(
The file holds the model, its parameters and its errors, and is itself a source of reflectance.
pbnbrdf info models: explains the models.
)")}
      .With(FitModelFields, RunFitModel);
}

}  // namespace pbnbrdf::cli
