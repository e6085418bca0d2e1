// pbnbrdf prior
#include <iostream>
#include <nlohmann/json.hpp>

#include "base/median.h"
#include "base/parallel.h"
#include "base/timer.h"
#include "command_line.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/database/table_components.h"
#include "pbnbrdf/database/train_family.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "problem/problem_fields.h"
#include "progress.h"
#include "sources/source_list.h"

namespace pbnbrdf::cli {
namespace {

enum class PriorModel { kNetwork, kPca };

constexpr NameTable<PriorModel, 2> kPriorModels = {
    {{"network", PriorModel::kNetwork}, {"pca", PriorModel::kPca}}};

constexpr std::size_t kHeldOutSamples = 20000;  // of each material, for the errors

struct PriorOptions {
  std::string material, out, summary;
  PriorModel model = PriorModel::kNetwork;
  bool quiet = false;
  FitProblem problem = FamilyProblem();
  FamilyOptions training;
};

Fields PriorFields(PriorOptions* options) {
  FamilyOptions* training = &options->training;
  Fields fields;
  fields.Group("The database and the files");
  fields.AddRequired(
      Text("material", &options->material, "its materials, a pattern or several, see below"));
  fields.AddRequired(Text("out", &options->out, "file for what they have in common"));
  fields.AddCommon(Text("summary", &options->summary, "JSON file for the errors of each material"));
  fields.AddCommon(Switch("quiet", &options->quiet, "print nothing"));
  fields.Group("The model");
  fields.AddCommon(
      Choice("model", &options->model, kPriorModels,
             "network: one whose weights depend on a code, a small file; pca: principal "
             "components of MERL tables, a large one that says more of a material "
             "measured at few directions"));
  fields.AddCommon(Integer("code_size", &training->code_size,
                           Between(1, WeightFamily::kMaxCodeSize),
                           "numbers of each material; of each of its channels with pca"));
  fields.AddCommon(Integer("max_iterations", &training->max_iterations, AtLeast(0),
                           "maximum number of iterations"));
  fields.AddCommon(Number("max_seconds", &training->max_seconds, Above(0.0),
                          "maximum time for the iterations, seconds"));
  fields.Add(
      Integer("threads", &training->threads, AtLeast(0), "threads to use; 0: one for each core"));
  fields.Add(NetworkFields(&options->problem.network));
  fields.Add(TermFields(&options->problem.terms));
  fields.Add(SamplingFields(&options->problem.sampling));
  return fields;
}

std::vector<DatabaseMaterial> OpenAll(const std::string& text) {
  const std::vector<std::string> sources = ExpandSources(text), names = NamesOfSources(sources);
  std::vector<DatabaseMaterial> materials;
  for (std::size_t m = 0; m < sources.size(); ++m) {
    materials.push_back({names[m], OpenBrdf(sources[m])});
  }
  return materials;
}

// How near a database's model comes to its materials.
struct Measured {
  std::vector<double> errors;       // mean absolute log errors (eq. 6)
  std::vector<double> max_albedos;  // directional
};

template <typename Model>
Measured Measure(const std::vector<DatabaseMaterial>& materials, const Model& model,
                 std::vector<double> max_albedos) {
  Measured measured = {std::vector<double>(materials.size()), std::move(max_albedos)};
  const bool has_albedos = !measured.max_albedos.empty();
  measured.max_albedos.resize(materials.size());
  ParallelFor(materials.size(), [&](std::size_t m) {
    const auto fit = model.Material(materials[m].name);
    const auto samples = HeldOutSamples(*materials[m].brdf, kHeldOutSamples, /*seed=*/1);
    measured.errors[m] = MeasureErrors(samples, fit).mean_abs_log_error;
    if (!has_albedos) measured.max_albedos[m] = MeasureEnergy(fit).max_directional_albedo;
  });
  return measured;
}

std::size_t CountCertified(const Measured& measured) {
  return static_cast<std::size_t>(
      std::count_if(measured.max_albedos.begin(), measured.max_albedos.end(),
                    [](double albedo) { return albedo <= 1.0 + Energy::kTolerance; }));
}

void Print(const PriorOptions& options, const std::vector<DatabaseMaterial>& materials,
           const std::string& how, const Measured& measured) {
  const auto worst = std::max_element(measured.errors.begin(), measured.errors.end());
  const auto index = static_cast<std::size_t>(worst - measured.errors.begin());
  std::cout << options.out << ": " << materials.size() << " materials, "
            << options.training.code_size
            << (options.model == PriorModel::kPca ? " numbers for each channel; "
                                                  : " numbers each; ")
            << how << "\nmean absolute log error: median " << Median(measured.errors) << ", worst "
            << *worst << " (" << materials[index].name << ")\nenergy: " << CountCertified(measured)
            << " of " << materials.size() << " certified\n";
}

Json SummaryJson(const PriorOptions& options, const std::vector<DatabaseMaterial>& materials,
                 double seconds, const Measured& measured) {
  Json rows = Json::array();
  for (std::size_t m = 0; m < materials.size(); ++m) {
    rows.push_back({{"name", materials[m].name},
                    {"mean_abs_log_error", measured.errors[m]},
                    {"max_directional_albedo", measured.max_albedos[m]}});
  }
  PriorOptions copy = options;
  return {{"version", PBNBRDF_VERSION},
          {"flags", PriorFields(&copy).Lines()},
          {"median_error", Median(measured.errors)},
          {"certified", CountCertified(measured)},
          {"seconds", seconds},
          {"materials", rows}};
}

// What the model was made by, and how near it comes.
struct Made {
  std::string how;
  double seconds;
  Measured measured;
};

Made MakeNetwork(const PriorOptions& options, const std::vector<DatabaseMaterial>& materials) {
  const ProgressLine line(options.quiet);
  FamilyOptions training = options.training;
  training.on_iteration = [&](const FamilyProgress& progress) {
    line.Show(StrCat("iteration ", progress.iteration, "  cost ", progress.cost, "  ",
                     SecondsText(progress.seconds)));
    return !Interrupted();
  };
  const TrainedFamily trained = TrainFamily(materials, options.problem, training);
  line.Clear();
  trained.family.Write(options.out);
  const std::string how =
      StrCat(trained.family.shape().Description(), ", ",
             NameOf(kEncodings, trained.family.shape().encoding()), " encoding; ",
             trained.iterations, " iterations, ", SecondsText(trained.seconds));
  return {how, trained.seconds, Measure(materials, trained.family, trained.max_albedos)};
}

Made MakePca(const PriorOptions& options, const std::vector<DatabaseMaterial>& materials) {
  const Timer timer;
  const TablePca pca = PrincipalComponents(materials, options.training.code_size);
  const double seconds = timer.Seconds();
  pca.Write(options.out);
  return {StrCat("principal components, ", SecondsText(seconds)), seconds,
          Measure(materials, pca, {})};
}

int RunPrior(const PriorOptions& options, const Arguments&) {
  const std::vector<Output> outputs = {{"out", options.out}, {"summary", options.summary}};
  CheckOutputs(outputs);
  CatchInterrupt();
  const std::vector<DatabaseMaterial> materials = OpenAll(options.material);
  Made made;
  WithThreads(options.training.threads, [&] {
    made = options.model == PriorModel::kPca ? MakePca(options, materials)
                                             : MakeNetwork(options, materials);
  });
  if (!options.summary.empty()) {
    WriteFile(options.summary,
              JsonText(SummaryJson(options, materials, made.seconds, made.measured)));
  }
  if (!options.quiet && !UseStandardOutput(outputs)) {
    Print(options, materials, made.how, made.measured);
  }
  return 0;
}

}  // namespace

Command PriorCommand() {
  return Command{.name = "prior",
                 .summary = "finds what the materials of a database have in common",
                 .usage = R"(  pbnbrdf prior --material='merl/*.binary' --out=merl.prior
  pbnbrdf prior --model=pca --code_size=64 --material='merl/*.binary' --out=merl.pca
)",
                 .notes = StrCat(kSourceNotes, R"(
--material is a pattern, or several separated by semicolons: 'merl/*.binary', 'sgd:parameters.csv#*'.

The file holds the materials, too: merl.prior#NAME is a source of reflectance like any other, and a
network that pbnbrdf export takes. With --prior=merl.pca, pbnbrdf fit fits a material from few
measurements, and pbnbrdf plan says which ones tell most. --samples are those of each material.
Ctrl-C ends the training with what there is.
)")}
      .With(PriorFields, RunPrior);
}

}  // namespace pbnbrdf::cli
