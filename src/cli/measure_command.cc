// pbnbrdf eval
#include <gflags/gflags.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "report.h"
#include "shared_flags.h"

DEFINE_uint64(eval_samples, 200000, "held-out samples");
DEFINE_uint64(eval_seed, 1, "of the held-out samples");

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kMostSamples = 100'000'000;

struct Fitted {
  std::unique_ptr<Brdf> brdf;
  std::size_t parameters;  // numbers that it stores
};

Fitted OpenFit(const std::string& path) {
  if (path.ends_with(".json")) {
    auto model = std::make_unique<AnalyticBrdf>(AnalyticBrdf::Read(path));
    const std::size_t parameters = model->parameters().size();
    return {std::move(model), parameters};
  }
  auto network = std::make_unique<NeuralBrdf>(OpenNetwork(path));
  const std::size_t parameters = network->weights().size();
  return {std::move(network), parameters};
}

int RunEval(const std::vector<std::string>&) {
  RequireFlag("fit", FLAGS_fit);
  CheckMaterialFlags();
  if (FLAGS_eval_samples < 1 || FLAGS_eval_samples > kMostSamples) {
    throw UsageError(
        StrCat("--eval_samples = ", FLAGS_eval_samples, "; must be 1 to ", kMostSamples));
  }
  const Fitted fit = OpenFit(FLAGS_fit);
  const std::unique_ptr<Brdf> material = OpenMaterial();
  const nlohmann::ordered_json measures = AboutMaterial([&] {
    return MeasureFit(*material, *fit.brdf, fit.parameters, FLAGS_eval_samples, FLAGS_eval_seed);
  });
  std::cout << (FLAGS_json ? measures.dump(2) + "\n" : MeasuresText(measures));
  return 0;
}

}  // namespace

Command EvalCommand() {
  Command command;
  command.name = "eval";
  command.summary = "measures a fit against its material";
  command.usage = "  pbnbrdf eval --fit=gold.safetensors --material=gold.binary --json\n";
  command.notes = kSourceNotes;
  command.flags = {MaterialFlagsAnd({"fit", "json", "eval_samples", "eval_seed"})};
  command.run = RunEval;
  return command;
}

}  // namespace pbnbrdf::cli
