// pbnbrdf fit
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/about.h"
#include "base/text.h"
#include "base/timer.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/solve/problem_file.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "progress.h"
#include "report.h"
#include "solve/fit_fields.h"

namespace pbnbrdf::cli {
namespace {

struct FitCommandOptions {
  MaterialOptions material;
  std::string init;  // a network to start from
  std::string out, summary, trace;
  bool quiet = false;
  FitSetup setup;
};

// What is fitted; with the fields of the setup that is all that it takes to repeat the fit.
Fields SubjectFields(FitCommandOptions* options) {
  Fields fields;
  fields.Group("The material and the files");
  fields.AddRequired(MaterialField(&options->material));
  fields.Add(ScaleField(&options->material));
  fields.Add(Text("init", &options->init,
                  "start from this fitted network, which has the same shape and encoding"));
  return fields;
}

Fields FitCommandFields(FitCommandOptions* options) {
  Fields fields = SubjectFields(options);
  fields.AddRequired(Text("out", &options->out, "file for the network, FILE.safetensors"));
  fields.AddCommon(Text("summary", &options->summary, "JSON file for errors and how the fit went"));
  fields.Add(Text("trace", &options->trace, "CSV file for a row of each iteration"));
  fields.AddCommon(Switch("quiet", &options->quiet, "print nothing"));
  fields.Add(Integer("threads", &options->setup.options.threads, AtLeast(0),
                     "threads to use; 0: one for each core"));
  fields.Add(FitFields(&options->setup.problem, &options->setup.options));
  return fields;
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

constexpr double kMinPart = 0.8;  // of --max_seconds, for the fit itself

// How --max_seconds is used: for reading, the fit and measuring it.
class TimeLimit {
 public:
  explicit TimeLimit(double max_seconds) : max_seconds_(max_seconds) {}

  // For a fit that starts now.
  double ForFit(double seconds_of_checks) const {
    return std::max(End() - timer_.Seconds() - seconds_of_checks, kMinPart * max_seconds_);
  }

  // For errors at held-out samples, after the fit. Negative if nothing is left.
  double ForErrors(double seconds_of_checks) const {
    return End() - timer_.Seconds() - seconds_of_checks;
  }

 private:
  // When all should be done: half of what a fit may run over, which is half a second or a tenth.
  double End() const { return max_seconds_ + std::max(0.25, 0.05 * max_seconds_); }

  const Timer timer_;
  const double max_seconds_;
};

std::string ProgressText(const FitProgress& progress) {
  return StrCat("iteration ", progress.iteration, "  cost ", progress.cost, "  held-out error ",
                progress.heldout_error, "  ", SecondsText(progress.seconds));
}

std::string TraceRow(const FitProgress& progress) {
  return StrCat(progress.iteration, ",", FormatNumber(progress.seconds), ",",
                FormatNumber(progress.cost), ",", FormatNumber(progress.heldout_error), "\n");
}

// With the rows of the trace.
Fit FitNetwork(const FitCommandOptions& options, const Brdf& material, double max_seconds,
               std::string* trace) {
  const FitProblem& problem = options.setup.problem;
  FitOptions fit_options = options.setup.options;
  if (!options.init.empty()) {
    fit_options.initial_weights = WeightsOf(options.init, problem.For(material).Shape());
  }
  fit_options.schedule.max_seconds = max_seconds;
  fit_options.limits_wall_time = true;
  const ProgressLine line(options.quiet);
  fit_options.reports_heldout_error = line.IsShown() || !options.trace.empty();
  fit_options.on_iteration = [&](const FitProgress& progress) {
    line.Show(ProgressText(progress));
    *trace += TraceRow(progress);
    return !Interrupted();
  };
  return About(options.material.source, [&] { return FitBrdf(material, problem, fit_options); });
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

int RunFit(const FitCommandOptions& options, const Arguments&) {
  CheckFlags([&] { ValidateFit(options.setup.problem, options.setup.options); });
  const std::vector<Output> outputs = {
      {"out", options.out}, {"summary", options.summary}, {"trace", options.trace}};
  CheckOutputs(outputs);
  CatchInterrupt();
  const TimeLimit limit(options.setup.options.schedule.max_seconds);
  const std::unique_ptr<Brdf> material = options.material.Open();
  const double checks = SecondsOfChecks(options.setup.problem.For(*material).Shape());
  std::string trace = "iteration,seconds,cost,heldout_error\n";
  const Fit fit = FitNetwork(options, *material, limit.ForFit(checks), &trace);
  const Json measures =
      MeasureFit(*material, fit.network, fit.network.weights().size(),
                 {.seconds = limit.ForErrors(checks), .profile = fit.summary.energy.profile});

  FitCommandOptions copy = options;
  const FitSubject subject = {
      options.material,
      SubjectFields(&copy).Lines() + ProblemText({fit.problem, options.setup.options})};
  WithMetadata(fit, subject, measures).Write(options.out);
  if (!options.summary.empty()) {
    WriteFile(options.summary, JsonText(FitSummaryJson(fit, subject, measures)));
  }
  if (!options.trace.empty()) WriteFile(options.trace, trace);
  if (!options.quiet && !UseStandardOutput(outputs))
    PrintFit(options.out, *material, fit, measures);
  return 0;
}

}  // namespace

Command FitCommand() {
  return Command{.name = "fit",
                 .summary = "fits a neural BRDF to a material",
                 .usage = R"(  pbnbrdf fit --material=gold.binary --out=gold.safetensors
  pbnbrdf fit --flagfile=problems/nbrdf.flags --material=gold.binary --out=gold.safetensors
)",
                 .notes = StrCat(kSourceNotes, R"(
The network's file and the summary record the flags that repeat the fit, bit for bit. Ctrl-C ends
the fit after the iteration and keeps the best network so far.
)")}
      .With(FitCommandFields, RunFit);
}

}  // namespace pbnbrdf::cli
