// pbnbrdf fit
#include <gflags/gflags.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "commands.h"
#include "fit_flags.h"
#include "fit_model.h"
#include "fit_record.h"
#include "fit_scene.h"
#include "interrupt.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/solve/fit.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "report.h"
#include "shared_flags.h"

DECLARE_string(encoding);
DECLARE_string(init);
DEFINE_string(summary, "", "write what was measured and done to this JSON file");
DEFINE_string(trace, "", "write a row for each iteration to this CSV");
DEFINE_bool(quiet, false, "print nothing");

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kSummarySamples = 100000;
constexpr std::uint64_t kSummarySeed = 1;

void ShowProgress(const FitProgress& progress) {
  std::fprintf(stderr, "\r\033[Kiteration %d  cost %.4g  held-out error %.5f  %.1f s",
               progress.iteration, progress.cost, progress.heldout_error, progress.seconds);
}

std::string TraceRow(const FitProgress& progress) {
  return StrCat(progress.iteration, ",", FormatNumber(progress.seconds), ",",
                FormatNumber(progress.cost), ",", FormatNumber(progress.heldout_error), "\n");
}

// What the energy term did, in a line; "" if it wasn't needed.
std::string EnergyText(const EnergySummary& energy) {
  if (energy.rounds == 0 && energy.correction == 0.0) return "";
  return StrCat("energy term: largest albedo ", energy.first_max_albedo, " without it, ",
                energy.rounds, " rounds, at the end log(1 + f) lowered by ", energy.correction,
                "\n");
}

// Throws UsageError if a file is named twice; empty names stand for none.
void CheckDifferent(const std::vector<std::string>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!outputs[i].empty() && outputs[i] == outputs[j]) {
        throw UsageError(StrCat(outputs[i], ": is to be two outputs at once"));
      }
    }
  }
}

// Of the network in a file, which must have the shape and the encoding that the problem has.
std::vector<double> WeightsOf(const std::string& path, const NetworkShape& shape) {
  const NeuralBrdf network = OpenNetwork(path);
  const auto describe = [](const NetworkShape& s) {
    return StrCat(s.Description(), ", ", NameOf(kEncodings, s.encoding()), " encoding");
  };
  const std::string found = describe(network.shape()), wanted = describe(shape);
  if (found != wanted) Fail(path, ": a network ", found, "; --init needs ", wanted);
  return network.weights();
}

int RunFit(const std::vector<std::string>&) {
  if (FitsScene()) return RunSceneFit();
  CheckMaterialFlags();
  RequireFlag("out", FLAGS_out);
  if (FitsModel()) return RunModelFit();
  FitFlags flags = ParseFitFlags();
  CheckDifferent({FLAGS_out, FLAGS_summary, FLAGS_trace});
  CheckWritable(FLAGS_out);
  if (!FLAGS_summary.empty()) CheckWritable(FLAGS_summary);
  if (!FLAGS_trace.empty()) CheckWritable(FLAGS_trace);
  CatchInterrupt();
  const std::unique_ptr<Brdf> material = OpenMaterial();
  ResolveNetwork(*material, &flags.problem);
  FLAGS_encoding = NameOf(kEncodings, flags.problem.encoding);  // for the flagfile of this fit
  if (!FLAGS_init.empty()) {
    flags.options.initial_weights = WeightsOf(FLAGS_init, flags.problem.Shape());
    ValidateFit(flags.problem, flags.options);
  }

  const bool show_progress = !FLAGS_quiet && isatty(STDERR_FILENO);
  std::string trace = "iteration,seconds,cost,heldout_error\n";
  flags.options.on_iteration = [&](const FitProgress& progress) {
    if (show_progress) ShowProgress(progress);
    trace += TraceRow(progress);
    return !Interrupted();
  };
  const Fit fit = AboutMaterial([&] { return FitBrdf(*material, flags.problem, flags.options); });
  if (show_progress) std::fprintf(stderr, "\r\033[K");

  const nlohmann::ordered_json measures = MeasureFit(
      *material, fit.network, fit.network.weights().size(), kSummarySamples, kSummarySeed);
  const FitSubject subject = {FLAGS_material, FLAGS_scale_to_albedo,
                              ProblemFlagfile(MaterialFlags())};
  NeuralBrdf(fit.network.shape(), fit.network.weights(),
             FitMetadata(subject, flags.problem, fit.summary, measures))
      .Write(FLAGS_out);
  if (!FLAGS_summary.empty()) {
    WriteFile(FLAGS_summary,
              JsonText(FitSummaryJson(subject, flags.problem, fit.summary, measures)));
  }
  if (!FLAGS_trace.empty()) WriteFile(FLAGS_trace, trace);
  if (!FLAGS_quiet) {
    std::cout << FLAGS_out << ": " << fit.network.Description() << "; "
              << NameOf(kTerminations, fit.summary.termination) << " after "
              << fit.summary.iterations << " iterations, " << fit.summary.seconds << " s\n"
              << MeasuresText(measures) << EnergyText(fit.summary.energy);
    if (fit.summary.termination == Termination::kDiverged) {
      std::cout << "diverged: " << fit.summary.message << "\n";
    }
    if (!material->IsIsotropic() && fit.network.IsIsotropic()) {
      std::cout << "the material is anisotropic, the fit the best isotropic one: "
                   "--encoding=anisotropic goes further\n";
    }
    if (fit.summary.precision_limited) {
      std::cout << "single precision limited the fit: --precision=double goes further\n";
    }
  }
  return 0;
}

}  // namespace

Command FitCommand() {
  Command command;
  command.name = "fit";
  command.summary = "fits a neural BRDF to a material, or an analytic model";
  command.usage =
      "  pbnbrdf fit --material=gold.binary --out=gold.safetensors\n"
      "  pbnbrdf fit --flagfile=problems/nbrdf.flags --material=gold.binary "
      "--out=gold.safetensors\n"
      "  pbnbrdf fit --model=ggx --lobes=2 --material=gold.binary --out=gold.json\n"
      "  pbnbrdf fit --scene=problems/scenes/sphere.json --out_dir=fits\n";
  command.notes =
      std::string(kSourceNotes) +
      "\nWith --model the file holds the model, its parameters and its errors; of the flags above "
      "it\n"
      "takes sampling, samples [6000], seed, loss_scale, starts [12], max_iterations [100] and\n"
      "function_tolerance [1e-05].\n"
      "\nWith --scene a few paths find out which materials the scene shows, and from where. Each "
      "is\n"
      "fitted, by the flags above, to OUT_DIR/NAME.safetensors: render --fits=OUT_DIR takes them. "
      "What\n"
      "hardly changes the image (by less than a hundredth of a change of log(1 + f cos)) gets\n"
      "--hidden=8,8 and 6000 samples at most, what no path gets to nothing. summary.json, or\n"
      "--summary, says for each what was needed and why. Ctrl-C keeps the networks so far.\n"
      "\nCtrl-C stops after the iteration and keeps the best network so far.\n";
  command.flags = {MaterialFlagsAnd({"out", "summary", "trace", "quiet", "threads"})};
  for (const FlagGroup& group : ProblemFlags()) command.flags.push_back(group);
  command.flags.push_back(ModelFlags());
  command.flags.push_back(SceneFlags());
  command.run = RunFit;
  return command;
}

}  // namespace pbnbrdf::cli
