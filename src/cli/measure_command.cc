// pbnbrdf measure
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "command_line.h"
#include "material_options.h"
#include "measure/measures.h"
#include "opened_fit.h"
#include "pbnbrdf/proof/energy_proof.h"
#include "progress.h"

namespace pbnbrdf::cli {
namespace {

const std::string kProofNotes =
    R"(max_directional_albedo is what a quadrature finds at many directions of the light. --prove
bounds it at all of them, by interval arithmetic. Networks whose values ripple take long: what
isn't proved in the time is said.

)";
constexpr double kMaxSamples = 1e8;  // 7 GB of samples

struct MeasureCommandOptions {
  std::string fit;
  MaterialOptions material;
  bool json = false;
  MeasureOptions measure;
  bool prove = false;
  EnergyProofOptions proof;
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
  fields.AddCommon(Switch("prove", &options->prove,
                          "prove a bound of the albedo for every direction of the light"));
  fields.AddCommon(Number("prove_seconds", &options->proof.seconds, Above(0.0),
                          "time for that; more gives a nearer bound"));
  return fields;
}

Json ProofJson(const EnergyProof& proof) {
  return {{"is_proved", proof.IsProved()},
          {"max_directional_albedo", proof.bound},
          {"proved_part", proof.proved_part},
          {"theta_i", proof.theta_i},
          {"phi_i", proof.phi_i},
          {"cells", proof.cells},
          {"pieces", proof.pieces},
          {"seconds", proof.seconds}};
}

std::string ProofText(const EnergyProof& proof, const NeuralBrdf& network) {
  std::string text =
      "\nWhat is proved, for every pair of directions, not only where it was measured:\n";
  if (proof.IsProved()) {
    text += StrCat("  energy: no directional albedo is above ", proof.bound);
  } else {
    text +=
        StrCat("  energy: no directional albedo is above 1 + 1e-6 for ", 100.0 * proof.proved_part,
               " % of the light's directions, none above ", proof.bound, " elsewhere");
  }
  text += StrCat(" (interval arithmetic on ", proof.pieces, " pieces in ", proof.seconds,
                 " s, rounding of about 1e-12 not included)\n  non-negativity: by construction, f "
                 "= max(0, expm1(z))\n");
  if (network.IsReciprocal()) {
    text +=
        "  reciprocity: by construction, the inputs have the same bits for wi and wo exchanged\n";
  }
  return text;
}

// Shows on a terminal how far it is.
EnergyProof Prove(const NeuralBrdf& network, EnergyProofOptions options) {
  const ProgressLine line(/*quiet=*/false);
  options.on_progress = [&](double proved_part, double seconds) {
    line.Show(StrCat("proved for ", std::lround(100.0 * proved_part),
                     " % of the light's directions, ", SecondsText(seconds)));
  };
  const EnergyProof proof = ProveEnergy(network, options);
  line.Show("");
  return proof;
}

int RunMeasure(const MeasureCommandOptions& options, const Arguments&) {
  const OpenedFit fit = OpenFit(options.fit);
  const std::unique_ptr<Brdf> material = options.material.Open();
  const auto* network = dynamic_cast<const NeuralBrdf*>(fit.brdf.get());
  if (options.prove && network == nullptr) Fail(options.fit, ": --prove needs a network");
  Json measures = About(options.material.source, [&] {
    return MeasureFit(*material, *fit.brdf, fit.parameters, options.measure);
  });
  std::string text = MeasuresText(measures);
  if (options.prove) {
    const EnergyProof proof = Prove(*network, options.proof);
    measures["energy_proof"] = ProofJson(proof);
    text += ProofText(proof, *network);
  }
  std::cout << (options.json ? JsonText(measures) : text);
  return 0;
}

}  // namespace

Command MeasureCommand() {
  return Command{.name = "measure",
                 .summary = "measures a fit against its material: errors, reciprocity, energy",
                 .usage = R"(  pbnbrdf measure --fit=gold.safetensors --material=gold.binary
  pbnbrdf measure --fit=gold.safetensors --material=gold.binary --json
  pbnbrdf measure --fit=gold.safetensors --material=gold.binary --prove
)",
                 .notes = kProofNotes + std::string(kSourceNotes)}
      .With(MeasureCommandFields, RunMeasure);
}

}  // namespace pbnbrdf::cli
