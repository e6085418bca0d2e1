// pbnbrdf measure
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "measure/measures.h"
#include "opened_fit.h"

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
  fields.AddRequired(FitField(&options->fit));
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
