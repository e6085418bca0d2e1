// pbnbrdf fit-model
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "model_fit.h"
#include "models/fit_analytic_fields.h"
#include "pbnbrdf/base/files.h"
#include "problem/problem_fields.h"

namespace pbnbrdf::cli {
namespace {

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

Json FitJson(const FitModelOptions& options, const ModelFit& model) {
  const AnalyticFit& fit = model.fit;
  FitModelOptions copy = options;
  Json json = ParseJson(fit.brdf.Json());
  json["source"] = fit.brdf.Text();
  json["version"] = PBNBRDF_VERSION;
  json["material"] = options.material.source;
  json["scale_to_albedo"] = options.material.scale_to_albedo;
  json["lobes"] = fit.brdf.lobes();
  json["seed"] = options.sampling.seed;
  json["sampling"] = NameOf(kSamplings, options.sampling.angles);
  json["samples"] = model.samples;
  json["loss_scale"] = options.fit.loss_scale;
  json["cost"] = fit.summary.final_cost;
  json["iterations"] = fit.summary.iterations;
  json["converged"] = fit.summary.converged;
  json["seconds"] = fit.summary.seconds;
  json["problem"] = SubjectFields(&copy).Lines() + SolutionFields(&copy).Lines();
  json["errors"] = model.errors;
  return json;
}

int RunFitModel(const FitModelOptions& options, const Arguments&) {
  if (options.out != "-" && !options.out.ends_with(".json")) {
    throw UsageError(StrCat("--out=", options.out, ": a model is written to a FILE.json"));
  }
  CheckOutputs({{"out", options.out}});
  const std::unique_ptr<Brdf> material = options.material.Open();
  const ModelFit model = About(options.material.source, [&] {
    return FitModel(*material, FindAnalyticModel(options.model), options.sampling, options.fit);
  });
  const AnalyticFit& fit = model.fit;
  WriteFile(options.out, JsonText(FitJson(options, model)));
  if (!options.quiet && options.out != "-") {
    std::cout << options.out << ": " << fit.brdf.Description() << "; "
              << (fit.summary.converged ? "converged" : "stopped") << " after "
              << fit.summary.iterations << " iterations, " << fit.summary.seconds << " s\n"
              << ErrorsText(model.errors);
  }
  return 0;
}

}  // namespace

Command FitModelCommand() {
  return Command{
      .name = "fit-model",
      .summary = "fits an analytic model to a material, to compare networks with, or for artists",
      .usage = R"(  pbnbrdf fit-model --model=ggx --material=gold.binary --out=gold.json
  pbnbrdf fit-model --model=ggx --lobes=2 --material=gold.binary --out=gold.json
  pbnbrdf fit-model --model=principled --material=gold.binary --out=gold.json
)",
      .notes = StrCat(kSourceNotes, R"(
The file holds the model, its parameters and its errors, and is itself a source of reflectance.
pbnbrdf info models: explains the models.
)")}
      .With(FitModelFields, RunFitModel);
}

}  // namespace pbnbrdf::cli
