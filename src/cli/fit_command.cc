// pbnbrdf fit
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "command_line.h"
#include "fit_collection.h"
#include "fit_record.h"
#include "pbnbrdf/base/files.h"
#include "progress.h"
#include "solve/fit_fields.h"
#ifdef PBNBRDF_HAS_RENDER
#include "report_fits.h"
#endif

namespace pbnbrdf::cli {
namespace {

struct FitCommandOptions {
  FitRequest request;
  std::string out, summary, trace;
  CollectionOptions collection;
  bool report = false;  // with --out_dir
  bool list = false;    // with --out_dir
};

Fields FitCommandFields(FitCommandOptions* options) {
  Fields fields = SubjectFields(&options->request);
  fields.AddCommon(Text("out", &options->out, "file for the network, FILE.safetensors"));
  fields.AddCommon(Text("out_dir", &options->collection.out_dir,
                        "folder for the networks of several materials, in place of --out"));
  fields.AddCommon(Text("summary", &options->summary, "JSON file for errors and how the fit went"));
  fields.Add(Text("trace", &options->trace, "CSV file for a row of each iteration"));
  fields.AddCommon(Switch("quiet", &options->collection.quiet, "print nothing"));
  fields.Add(Integer("threads", &options->request.setup.options.threads, AtLeast(0),
                     "threads to use; 0: one for each core"));
  fields.AddCommon(Integer("jobs", &options->collection.jobs, AtLeast(0),
                           "with --out_dir: fits at a time; 0: one for each core"));
  fields.Add(Switch("list", &options->list,
                    "with --out_dir: print the materials' names, a line each, and end"));
  fields.Add(
      Text("only", &options->collection.only,
           "with --out_dir: names of materials, between semicolons, to fit these alone; a run "
           "without it makes the table"));
  fields.Add(Choice("progress", &options->collection.progress, kProgressStyles,
                    "with --out_dir: how progress is told, on standard error"));
#ifdef PBNBRDF_HAS_RENDER
  fields.Add(Switch("report", &options->report,
                    "with --out_dir: also make the page OUT_DIR/fits.html of all fits"));
#endif
  fields.Add(FitFields(&options->request.setup.problem, &options->request.setup.options));
  return fields;
}

std::string ProgressText(const FitProgress& progress) {
  return StrCat("iteration ", progress.iteration, "  cost ", progress.cost, "  held-out error ",
                progress.heldout_error, "  ", SecondsText(progress.seconds));
}

std::string TraceRow(const FitProgress& progress) {
  return StrCat(progress.iteration, ",", FormatNumber(progress.seconds), ",",
                FormatNumber(progress.cost), ",", FormatNumber(progress.heldout_error), "\n");
}

// What the energy term did, in a line; "" if it wasn't needed.
std::string EnergyText(const EnergySummary& energy) {
  if (energy.rounds == 0 && energy.correction == 0.0) return "";
  return StrCat("energy term: largest albedo ", energy.first_max_albedo, " without it; ",
                energy.rounds,
                " rounds with it; what was left took a mean change of log(1 + f) of ",
                energy.correction, "\n");
}

void PrintFit(const std::string& out, const Brdf& material, const Fit& fit, const Json& measures) {
  const FitSummary& summary = fit.summary;
  std::cout << out << ": " << fit.network.Description() << "; "
            << NameOf(kTerminations, summary.termination) << " after " << summary.iterations
            << " iterations, " << summary.seconds << " s\n"
            << MeasuresText(measures) << EnergyText(summary.energy);
  if (summary.termination == Termination::kMaxSeconds) {
    std::cout << "--max_seconds ended the fit before it was done: more time gets closer\n";
  }
  if (summary.termination == Termination::kDiverged) {
    std::cout << "diverged: " << summary.message << "\n";
  }
  if (!material.IsIsotropic() && fit.network.IsIsotropic()) {
    std::cout << "the material is anisotropic, and this is the best isotropic fit: "
                 "--encoding=anisotropic gets closer\n";
  }
  if (summary.precision_limited) {
    std::cout << "single precision limited the fit: --precision=double gets closer\n";
  }
}

int FitOne(const FitCommandOptions& options) {
  const std::vector<Output> outputs = {
      {"out", options.out}, {"summary", options.summary}, {"trace", options.trace}};
  CheckOutputs(outputs);
  const bool quiet = options.collection.quiet;
  const MaterialFitter fitter(options.request);
  const ProgressLine line(quiet);
  std::string trace = "iteration,seconds,cost,heldout_error\n";
  const auto [fit, measures, subject] =
      fitter.Run(line.IsShown() || !options.trace.empty(), [&](const FitProgress& progress) {
        line.Show(ProgressText(progress));
        trace += TraceRow(progress);
        return !Interrupted();
      });
  line.Clear();
  WithMetadata(fit, subject, measures).Write(options.out);
  if (!options.summary.empty()) {
    WriteFile(options.summary, JsonText(FitSummaryJson(fit, subject, measures)));
  }
  if (!options.trace.empty()) WriteFile(options.trace, trace);
  if (!quiet && !UseStandardOutput(outputs)) {
    PrintFit(options.out, fitter.material(), fit, measures);
  }
  return 0;
}

int FitMany(const FitCommandOptions& options) {
  if (options.list) {
    for (const std::string& name : CollectionNames(options.request.material.source)) {
      std::cout << name << "\n";
    }
    return 0;
  }
  CollectionOptions collection = options.collection;
#ifdef PBNBRDF_HAS_RENDER
  if (options.report) {
    collection.when_done = [&] {
      ReportRequest report;
      report.which.fits = collection.out_dir;
      report.out = std::filesystem::path(collection.out_dir) / "fits.html";
      report.threads = options.request.setup.options.threads;
      report.quiet = collection.quiet;
      WriteReport(report);
    };
  }
#endif
  return FitCollection(options.request, collection);
}

int RunFit(const FitCommandOptions& options, const Arguments&) {
  CheckFlags([&] { ValidateFit(options.request.setup.problem, options.request.setup.options); });
  const std::string& out_dir = options.collection.out_dir;
  if (out_dir.empty() == options.out.empty()) throw UsageError("--out or --out_dir is required");
  if (!out_dir.empty() && !(options.summary.empty() && options.trace.empty())) {
    throw UsageError("--summary and --trace are for --out; --out_dir has a summary for each fit");
  }
  if (out_dir.empty() && options.report) {
    throw UsageError("--report is for --out_dir; pbnbrdf report makes the page of one fit");
  }
  if (out_dir.empty() && (options.list || !options.collection.only.empty())) {
    throw UsageError("--list and --only are for --out_dir");
  }
  if (options.report && !options.collection.only.empty()) {
    throw UsageError("--report is for all fits of --out_dir, the run without --only");
  }
  CatchInterrupt();
  return out_dir.empty() ? FitOne(options) : FitMany(options);
}

}  // namespace

Command FitCommand() {
  return Command{.name = "fit",
                 .summary = "fits a neural BRDF to a material",
                 .usage = R"(  pbnbrdf fit --material=gold.binary --out=gold.safetensors
  pbnbrdf fit --flagfile=problems/nbrdf.flags --material=gold.binary --out=gold.safetensors
  pbnbrdf fit --material='merl/*.binary' --out_dir=fits --jobs=2
)",
                 .notes = StrCat(kSourceNotes, R"(
The network's file and the summary record the flags that repeat the fit, bit for bit. Ctrl-C ends
the fit after the iteration and keeps the best network so far.

With --out_dir, --material is a pattern, or several separated by semicolons: 'merl/*.binary',
'sgd:parameters.csv#*', 'builtin:*'. OUT_DIR gets NAME.safetensors and NAME.json of each material, a
table of all, fits.csv and fits.json, and with --report a page, fits.html. Fits that it has are kept
where material, problem and version are the same, so that a run that was ended goes on. A material
that fails doesn't stop the others. fits.json says how many seconds the run took, and how many its
jobs spent on fits, all together. On a cluster each job fits one material, by --only, and a last run
makes the table: experiments/cluster has a workflow of Snakemake.
)")}
      .With(FitCommandFields, RunFit);
}

}  // namespace pbnbrdf::cli
