// pbnbrdf fit-scene
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/timer.h"
#include "command_line.h"
#include "fit_record.h"
#include "material_options.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/render/demand.h"
#include "pbnbrdf/solve/problem_file.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "problem/problem_fields.h"
#include "progress.h"
#include "render_summary.h"
#include "solve/fit_fields.h"

namespace pbnbrdf::cli {
namespace {

const std::vector<SkipReason> kReasons = {SkipReason::kUnreferenced, SkipReason::kNotReached};

struct FitSceneOptions {
  std::string scene, out_dir, summary;
  bool no_skip = false, quiet = false;
  FitSetup setup;

  std::string InFolder(const std::string& file) const {
    return std::filesystem::path(out_dir) / file;
  }
  std::string SummaryFile() const { return summary.empty() ? InFolder("summary.json") : summary; }
  bool Prints() const { return !quiet && SummaryFile() != "-"; }
};

Field SceneField(FitSceneOptions* options) {
  return Text("scene", &options->scene,
              "scene file (JSON); problems/scenes/README.md describes it");
}

Fields FitSceneFields(FitSceneOptions* options) {
  Fields fields;
  fields.Group("The scene and the files");
  fields.AddRequired(SceneField(options));
  fields.AddRequired(Text("out_dir", &options->out_dir,
                          "folder for the networks, MATERIAL.safetensors, and summary.json"));
  fields.AddCommon(Text("summary", &options->summary, "another file than OUT_DIR/summary.json"));
  fields.AddCommon(
      Switch("no_skip", &options->no_skip, "fit the materials that the image doesn't show, too"));
  fields.AddCommon(Switch("quiet", &options->quiet, "print nothing"));
  fields.Add(Integer("threads", &options->setup.options.threads, AtLeast(0),
                     "threads to use; 0: one for each core"));
  fields.Add(FitFields(&options->setup.problem, &options->setup.options));
  fields.Add(SceneFields(&options->setup.problem.sampling));
  return fields;
}

// The flags that repeat the fit of one material.
std::string Flagfile(FitSceneOptions options, const FitProblem& fitted) {
  options.setup.problem = fitted;
  return Fields().Add(SceneField(&options)).Lines() + ProblemText(options.setup) +
         SceneFields(&options.setup.problem.sampling).Lines();
}

// Which fit a material of the scene gets.
struct ScenePlan {
  std::string name;
  MaterialOptions material;
  MaterialDemand demand;
  std::optional<SkipReason> skip_reason;  // none: the material is fitted
  std::string why;                        // it is fitted or not, a sentence
  FitProblem problem;
};

// Below this an error of log(1 + f cos) changes the image by less than a hundredth of itself: even ten times
// the usual error doesn't show. Such a material gets a tenth of the samples and weights.
constexpr double kMinSensitivity = 0.01;
constexpr std::uint64_t kFewSamples = 6000;
const std::vector<int> kSmallNetwork = {8, 8};

// "35 %", "0.012 %"
std::string Percent(double part) {
  std::ostringstream text;
  text << std::setprecision(2) << 100.0 * part << " %";
  return text.str();
}

void MakeSmall(FitProblem* problem) {
  FitProblem small = *problem;
  small.network.hidden = kSmallNetwork;
  if (small.Shape().num_weights() < problem->Shape().num_weights()) *problem = small;
  problem->sampling.samples = std::min(problem->sampling.samples, kFewSamples);
}

// problem: what the flags ask for. A material that hardly changes the image gets a small network and few
// samples, unless the flags ask for even fewer.
ScenePlan PlanFit(const SceneMaterial& material, const MaterialDemand& demand,
                  const FitProblem& problem) {
  ScenePlan plan = {material.name, {material.source, material.scale_to_albedo}, demand, {}, "",
                    problem};
  if (!demand.reached) {
    plan.skip_reason = demand.referenced ? SkipReason::kNotReached : SkipReason::kUnreferenced;
    plan.why = demand.referenced ? "no path hits it" : "no shape has it";
    return plan;
  }
  plan.problem.sampling.asked = demand.angles;
  plan.why = StrCat("it reflects ", Percent(demand.share), " of the image's light");
  if (demand.sensitivity < kMinSensitivity) {
    MakeSmall(&plan.problem);
    plan.why += " and hardly changes it: a small network and few samples";
  }
  return plan;
}

Json PlanJson(const ScenePlan& plan, bool skips) {
  Json skipped;
  if (skips) skipped = NameOf(kSkipReasons, *plan.skip_reason);
  return {{"material", plan.name},
          {"source", plan.material.source},
          {"share", plan.demand.share},
          {"sensitivity", plan.demand.sensitivity},
          {"needed", plan.demand.reached},
          {"skipped", skipped},
          {"why", plan.why}};
}

std::vector<ScenePlan> PlanFits(const Scene& scene, const FitSceneOptions& options) try {
  const auto open = [](const std::string& source) { return OpenedMaterial{OpenBrdf(source)}; };
  const FitProblem& problem = options.setup.problem;
  const std::vector<MaterialDemand> demand = MeasureDemand(
      scene, open, {.seed = problem.sampling.seed, .threads = options.setup.options.threads});
  std::vector<ScenePlan> plans;
  for (std::size_t i = 0; i < demand.size(); ++i) {
    plans.push_back(PlanFit(scene.materials[i], demand[i], problem));
  }
  return plans;
} catch (const Error& error) {
  Fail(options.scene, ": ", error.what());
}

Fit FitPlanned(const ScenePlan& plan, const Brdf& material, const FitSceneOptions& options) {
  const ProgressLine line(options.quiet);
  FitOptions fit_options = options.setup.options;
  fit_options.reports_heldout_error = line.IsShown();
  fit_options.limits_wall_time = true;
  fit_options.on_iteration = [&](const FitProgress& progress) {
    line.Show(StrCat(plan.name, "  iteration ", progress.iteration, "  held-out error ",
                     progress.heldout_error, "  ", SecondsText(progress.seconds)));
    return !Interrupted();
  };
  return FitBrdf(material, plan.problem, fit_options);
}

// Fits the material and writes its network. Returns what the summary says of it.
Json RunPlan(const ScenePlan& plan, const FitSceneOptions& options) try {
  const std::unique_ptr<Brdf> material = plan.material.Open();
  const Fit fit = FitPlanned(plan, *material, options);
  const Json measures = MeasureFit(*material, fit.network, fit.network.weights().size());
  const FitSubject subject = {plan.material, Flagfile(options, fit.problem)};
  const std::string file = plan.name + ".safetensors";
  WithMetadata(fit, subject, measures).Write(options.InFolder(file));
  if (options.Prints()) {
    std::cout << plan.name << ": " << fit.network.Description() << ", " << fit.summary.seconds
              << " s; " << plan.why << "\n";
  }
  Json json = PlanJson(plan, /*skips=*/false);
  json["file"] = file;
  json["hidden"] = fit.problem.network.hidden;
  json.update(FitSummaryJson(fit, subject, measures));
  json["material"] = plan.name;
  return json;
} catch (const Error& error) {
  Fail(options.scene, ": materials.", plan.name, ": ", error.what());
}

// Names that can be files, and a folder to write them to.
void PrepareOutputs(const Scene& scene, const FitSceneOptions& options) {
  for (const SceneMaterial& material : scene.materials) {
    if (material.name.empty() || material.name.find('/') != std::string::npos) {
      Fail(options.scene, ": materials.", material.name, ": a file can't have this name");
    }
  }
  std::error_code code;
  std::filesystem::create_directories(options.out_dir, code);
  CheckWritable(options.InFolder("summary.json"));
  CheckOutputs({{"summary", options.SummaryFile()}});
}

int RunFitScene(const FitSceneOptions& options, const Arguments&) {
  CheckFlags([&] { ValidateFit(options.setup.problem, options.setup.options); });
  const Scene scene = ReadSceneAndTell(options.scene);
  PrepareOutputs(scene, options);
  CatchInterrupt();
  const Timer timer;
  const std::vector<ScenePlan> plans = PlanFits(scene, options);
  const double demand_seconds = timer.Seconds();
  Work work;
  Json fits = Json::array();
  for (const ScenePlan& plan : plans) {
    work.needed += plan.demand.reached;
    const bool skips = plan.skip_reason && !options.no_skip;
    if (skips) ++work.Skipped(*plan.skip_reason);
    if (skips || Interrupted()) {
      fits.push_back(PlanJson(plan, skips));
      continue;
    }
    const ScopedTimer scoped(&work.seconds);
    fits.push_back(RunPlan(plan, options));
    ++work.done;
  }
  const Json summary = {{"scene", options.scene},
                        {"interrupted", Interrupted()},
                        {"demand_seconds", demand_seconds},
                        {"seconds", timer.Seconds()},
                        {"materials", WorkJson(work, kReasons)},
                        {"fits", fits},
                        {"version", PBNBRDF_VERSION}};
  WriteFile(options.SummaryFile(), JsonText(summary));
  if (options.Prints()) std::cout << WorkText("materials", work, kReasons);
  return 0;
}

}  // namespace

Command FitSceneCommand() {
  return Command{
      .name = "fit-scene",
      .summary = "fits a network to each material that the image of a scene shows",
      .usage = R"(  pbnbrdf fit-scene --scene=problems/scenes/one_of_many.json --out_dir=fits
  pbnbrdf render --scene=problems/scenes/one_of_many.json --fits=fits --out=many.exr
)",
      .notes =
          R"(A quick render finds out which materials the image shows, and at which angles. Each of them is
fitted at these angles, by the flags above, and written to OUT_DIR/NAME.safetensors, where render
--fits=OUT_DIR finds it. A material that hardly shows (a change of its log(1 + f cos) by 0.1 would
change the image by less than 0.1 %) gets --hidden=8,8 and at most 6000 samples. A material that the
image doesn't show is not fitted.
The summary says of each material what was done and why, and records the flags that repeat its fit.
Ctrl-C ends the fits and keeps the networks so far.
)"}
      .With(FitSceneFields, RunFitScene);
}

}  // namespace pbnbrdf::cli
