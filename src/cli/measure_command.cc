// pbnbrdf measure
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "report.h"

namespace pbnbrdf::cli {
namespace {

constexpr double kMaxSamples = 1e8;  // 7 GB of samples

struct MeasureCommandOptions {
  std::string fit;
  MaterialOptions material;
  bool json = false;
  MeasureOptions measure;
};

Fields MeasureCommandFields(MeasureCommandOptions* options) {
  Fields fields;
  fields.AddRequired(Text("fit", &options->fit,
                          "fitted network (.safetensors, or NBRDF's .h5 or fc1.npy) or analytic "
                          "model (.json)"));
  fields.AddRequired(MaterialField(&options->material));
  fields.AddCommon(ScaleField(&options->material));
  fields.AddCommon(SymmetrizeField(&options->material.symmetrize));
  fields.AddCommon(Switch("json", &options->json, "print one JSON object"));
  fields.AddCommon(Integer("samples", &options->measure.samples, Between(1, kMaxSamples),
                           "held-out samples that errors are measured at"));
  fields.AddCommon(
      Integer("seed", &options->measure.seed, AtLeast(0), "seed of the held-out samples"));
  return fields;
}

struct OpenedFit {
  std::unique_ptr<Brdf> brdf;
  std::size_t parameters;  // numbers that it stores
};

OpenedFit OpenFit(const std::string& source) {
  std::unique_ptr<Brdf> brdf = OpenBrdf(source);
  std::size_t parameters = 0;
  if (const auto* network = dynamic_cast<const NeuralBrdf*>(brdf.get())) {
    parameters = network->weights().size();
  } else if (const auto* model = dynamic_cast<const AnalyticBrdf*>(brdf.get())) {
    parameters = model->parameters().size();
  } else {
    Fail(source, ": neither a fitted network nor an analytic model");
  }
  return {std::move(brdf), parameters};
}

int RunMeasure(const MeasureCommandOptions& options, const Arguments&) {
  const OpenedFit fit = OpenFit(options.fit);
  const std::unique_ptr<Brdf> material = options.material.Open();
  const Json measures = About(options.material.source, [&] {
    return MeasureFit(*material, *fit.brdf, fit.parameters, options.measure);
  });
  std::cout << (options.json ? JsonText(measures) : MeasuresText(measures));
  return 0;
}

}  // namespace

Command MeasureCommand() {
  return Command{.name = "measure",
                 .summary = "measures a fit against its material: errors, reciprocity, energy",
                 .usage = R"(  pbnbrdf measure --fit=gold.safetensors --material=gold.binary
  pbnbrdf measure --fit=gold.safetensors --material=gold.binary --json
)",
                 .notes = kSourceNotes}
      .With(MeasureCommandFields, RunMeasure);
}

}  // namespace pbnbrdf::cli
