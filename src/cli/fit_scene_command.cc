#include "fit_scene.h"

#include <gflags/gflags.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "base/text.h"
#include "base/timer.h"
#include "fit_flags.h"
#include "fit_record.h"
#include "interrupt.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/brdf/scaled.h"
#include "pbnbrdf/render/demand.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "render_summary.h"
#include "report.h"
#include "shared_flags.h"

DEFINE_string(out_dir, "", "folder for the networks, MATERIAL.safetensors, and summary.json");
DEFINE_double(scene_floor, pbnbrdf::FitProblem().asked_floor,
              "part of the training samples that --sampling draws; the scene draws the others");

DECLARE_bool(no_skip);
DECLARE_bool(quiet);
DECLARE_int32(threads);
DECLARE_string(scene);
DECLARE_string(summary);

namespace pbnbrdf::cli {
namespace {

constexpr std::size_t kMeasuredSamples = 100000;
constexpr std::uint64_t kMeasuredSeed = 1;

const std::vector<SkipReason> kReasons = {SkipReason::kUnreferenced, SkipReason::kNotReached};

// A material whose sensitivity is below gets a network and samples to match, unless the flags ask
// for even fewer.
constexpr double kHardlyShown = 0.01;
constexpr std::size_t kFewSamples = 6000;
const std::vector<int> kSmallNetwork = {8, 8};

std::string InFolder(const std::string& file) {
  return std::filesystem::path(FLAGS_out_dir) / file;
}

// What becomes of a material.
struct Plan {
  std::string name;
  FitSubject subject;
  double share = 0.0, sensitivity = 0.0;
  bool needed = false;
  std::optional<SkipReason> skip_reason;  // none: it is fitted
  std::string why;
  FitProblem problem;
};

// "35 %", "0.012 %"
std::string Percent(double part) {
  std::ostringstream text;
  text << std::setprecision(2) << 100.0 * part << " %";
  return text.str();
}

Plan MakePlan(const SceneMaterial& material, const MaterialDemand& demand,
              const FitProblem& problem) {
  Plan plan;
  plan.name = material.name;
  plan.subject = {material.source, material.scale_to_albedo,
                  ProblemFlagfile({"scene", "scene_floor"})};
  plan.share = demand.share;
  plan.sensitivity = demand.sensitivity;
  plan.needed = demand.reached;
  plan.problem = problem;
  if (!demand.reached) {
    plan.skip_reason = demand.referenced ? SkipReason::kNotReached : SkipReason::kUnreferenced;
    plan.why = demand.referenced ? "no path gets there" : "no shape has it";
    return plan;
  }
  plan.problem.asked = demand.angles;
  plan.why = StrCat("it reflects ", Percent(demand.share), " of the image's light");
  if (demand.sensitivity >= kHardlyShown) return plan;
  FitProblem small = problem;
  small.hidden = kSmallNetwork;
  if (small.Shape().num_weights() < problem.Shape().num_weights()) {
    plan.problem.hidden = kSmallNetwork;
  }
  plan.problem.samples = std::min(problem.samples, kFewSamples);
  plan.why += " and hardly changes it: a small network and few samples";
  return plan;
}

std::vector<MaterialDemand> Demand(const Scene& scene, const DemandOptions& options) try {
  const auto open = [](const std::string& source) { return OpenedMaterial{OpenBrdf(source)}; };
  return MeasureDemand(scene, open, options);
} catch (const Error& error) {
  Fail(FLAGS_scene, ": ", error.what());
}

class SceneFitter {
 public:
  SceneFitter(const Scene& scene, const FitFlags& flags) : flags_(flags) {
    const std::vector<MaterialDemand> demand =
        Demand(scene, {.seed = flags.problem.seed, .threads = FLAGS_threads});
    demand_seconds_ = timer_.Seconds();
    for (std::size_t i = 0; i < demand.size(); ++i) {
      plans_.push_back(MakePlan(scene.materials[i], demand[i], flags.problem));
      work_.needed += plans_.back().needed;
    }
  }

  void Run() {
    for (const Plan& plan : plans_) {
      const bool skips = plan.skip_reason && !FLAGS_no_skip;
      if (skips) ++work_.Skipped(*plan.skip_reason);
      if (skips || Interrupted()) {
        fits_.push_back(PlanJson(plan));
      } else {
        Fit(plan);
      }
    }
  }

  nlohmann::ordered_json Summary() const {
    return {{"scene", FLAGS_scene},
            {"interrupted", Interrupted()},
            {"demand_seconds", demand_seconds_},
            {"seconds", timer_.Seconds()},
            {"materials", WorkJson(work_, kReasons)},
            {"fits", fits_},
            {"version", PBNBRDF_VERSION}};
  }

  // A line.
  std::string Text() const { return WorkText("materials", work_, kReasons); }

 private:
  nlohmann::ordered_json PlanJson(const Plan& plan) const {
    nlohmann::ordered_json skipped;
    if (plan.skip_reason && !FLAGS_no_skip) skipped = NameOf(kSkipReasons, *plan.skip_reason);
    return {{"material", plan.name}, {"source", plan.subject.material},
            {"share", plan.share},   {"sensitivity", plan.sensitivity},
            {"needed", plan.needed}, {"skipped", skipped},
            {"why", plan.why}};
  }

  void Fit(const Plan& plan) try {
    const Timer timer;
    std::unique_ptr<Brdf> material = OpenBrdf(plan.subject.material);
    if (plan.subject.scale_to_albedo > 0.0) {
      material = ScaleToAlbedo(std::move(material), plan.subject.scale_to_albedo);
    }
    FitProblem problem = plan.problem;
    ResolveNetwork(*material, &problem);
    FitOptions options = flags_.options;
    options.on_iteration = [&](const FitProgress& progress) {
      if (show_progress_) ShowProgress(plan, progress);
      return !Interrupted();
    };
    const pbnbrdf::Fit fit = FitBrdf(*material, problem, options);
    const nlohmann::ordered_json measures = MeasureFit(
        *material, fit.network, fit.network.weights().size(), kMeasuredSamples, kMeasuredSeed);
    const std::string file = plan.name + ".safetensors";
    NeuralBrdf(fit.network.shape(), fit.network.weights(),
               FitMetadata(plan.subject, problem, fit.summary, measures))
        .Write(InFolder(file));
    ++work_.done;
    work_.seconds += timer.Seconds();
    nlohmann::ordered_json json = PlanJson(plan);
    json["file"] = file;
    json["hidden"] = problem.hidden;
    json.update(FitSummaryJson(plan.subject, problem, fit.summary, measures));
    json["material"] = plan.name;
    fits_.push_back(std::move(json));
    Report(plan, fit);
  } catch (const Error& error) {
    Fail(FLAGS_scene, ": materials.", plan.name, ": ", error.what());
  }

  void ShowProgress(const Plan& plan, const FitProgress& progress) const {
    std::fprintf(stderr, "\r\033[K%s  iteration %d  held-out error %.5f  %.1f s", plan.name.c_str(),
                 progress.iteration, progress.heldout_error, progress.seconds);
  }

  void Report(const Plan& plan, const pbnbrdf::Fit& fit) const {
    if (show_progress_) std::fprintf(stderr, "\r\033[K");
    if (FLAGS_quiet) return;
    std::cout << plan.name << ": " << fit.network.Description() << ", " << fit.summary.seconds
              << " s; " << plan.why << "\n";
  }

  const FitFlags& flags_;
  const Timer timer_;
  const bool show_progress_ = !FLAGS_quiet && isatty(STDERR_FILENO);
  double demand_seconds_ = 0.0;
  std::vector<Plan> plans_;
  Work work_;
  nlohmann::ordered_json fits_ = nlohmann::ordered_json::array();
};

// Names that can be files, and a folder to write them to.
void PrepareOutputs(const Scene& scene, const std::string& summary) {
  for (const SceneMaterial& material : scene.materials) {
    if (material.name.empty() || material.name.find('/') != std::string::npos) {
      Fail(FLAGS_scene, ": materials.", material.name, ": the name can't be that of a file");
    }
  }
  std::error_code code;
  std::filesystem::create_directories(FLAGS_out_dir, code);
  CheckWritable(InFolder("summary.json"));
  CheckWritable(summary);
}

}  // namespace

FlagGroup SceneFlags() {
  return {"The materials of a scene", {"scene", "out_dir", "scene_floor", "no_skip"}};
}

bool FitsScene() {
  if (FLAGS_scene.empty()) {
    for (const char* name : {"out_dir", "scene_floor", "no_skip"}) {
      if (IsGiven(name)) throw UsageError(StrCat("--", name, " is a flag of --scene"));
    }
    return false;
  }
  for (const char* name :
       {"material", "scale_to_albedo", "out", "trace", "init", "model", "lobes"}) {
    if (IsGiven(name)) throw UsageError(StrCat("--", name, " doesn't go with --scene"));
  }
  return true;
}

int RunSceneFit() {
  RequireFlag("out_dir", FLAGS_out_dir);
  if (!(FLAGS_scene_floor >= 0.0 && FLAGS_scene_floor <= 1.0)) {
    throw UsageError(StrCat("--scene_floor = ", FLAGS_scene_floor, "; must be 0 to 1"));
  }
  FitFlags flags = ParseFitFlags();
  flags.problem.asked_floor = FLAGS_scene_floor;
  const std::string summary = FLAGS_summary.empty() ? InFolder("summary.json") : FLAGS_summary;
  const Scene scene = ReadScene(FLAGS_scene);
  PrepareOutputs(scene, summary);
  CatchInterrupt();
  SceneFitter fitter(scene, flags);
  fitter.Run();
  WriteFile(summary, JsonText(fitter.Summary()));
  if (!FLAGS_quiet) std::cout << fitter.Text();
  return 0;
}

}  // namespace pbnbrdf::cli
