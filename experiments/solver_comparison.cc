// solver_comparison.cc: held-out error against time of every solver, and of another implementation.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/text.h"
#include "comparison.h"
#include "experiment.h"
#include "fit_log.h"
#include "materials.h"
#include "option_fields.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "problems.h"

namespace pbnbrdf {
namespace {

const std::string kUsage =
    R"(solver_comparison: held-out error against time of every solver, beside another implementation.

  solver_comparison --out_dir=results builtin:satin-gold metal=sgd:parameters.csv#chrome-steel
  solver_comparison --out_dir=results --peer=published_recipe.py --seeds=1,2,3 merl/*.binary

The arguments are materials; without any, a few built-in ones. Each is tabulated as a MERL file, and
that is what every solver fits, one after the other. Writes solver_comparison.csv, with a row for each
iteration, solver_comparison.md and solver_comparison.svg.
)" + std::string(kMaterialsHelp);

const Arguments kDefaultMaterials = {"builtin:ivory-computer-plastic", "builtin:red-satin-plastic",
                                     "builtin:satin-gold"};

enum class Method { kNbrdf, kPbnbrdf };

constexpr NameTable<Method, 2> kMethods = {
    {{"nbrdf", Method::kNbrdf}, {"pbnbrdf", Method::kPbnbrdf}}};

struct Options {
  Method method = Method::kNbrdf;
  std::vector<std::string> solvers = {"lm", "ceres_lm", "ceres_lbfgs", "ceres_lbfgs_absolute",
                                      "adam"};
  std::vector<std::vector<int>> hidden = {{21, 21}};
  std::vector<int> seeds = {1};
  int threads = 2;
  double max_seconds = 60.0;
  int lm_iterations = ScheduleOptions{}.max_iterations;
  int lbfgs_iterations = 10000;
  std::optional<int> adam_epochs;
  std::optional<std::uint64_t> adam_samples;
  std::uint64_t heldout_samples = 200000;
  std::string peer, peer_python = "/usr/bin/python3", peer_flags;
  std::string sgd;
};

Fields FieldsOf(Options* o) {
  Fields fields;
  fields.Add(
      Choice("method", &o->method, kMethods,
             "problem: nbrdf is the default one for our solvers and problems/nbrdf_adam.flags "
             "for adam, pbnbrdf has problems/pbnbrdf.flags and problems/pbnbrdf_adam.flags; "
             "the peer gets the name"));
  fields.Add(Texts("solvers", &o->solvers,
                   "any of lm, ceres_lm, ceres_lbfgs, ceres_lbfgs_absolute and adam; "
                   "ceres_lbfgs_absolute minimises the papers' own sum of absolute values"));
  fields.Add(Networks("hidden", &o->hidden,
                      "sizes of the hidden layers of each network: '8,8,8 21,21 64,64,64'"));
  fields.Add(Integers("seeds", &o->seeds, AtLeast(1), "seeds of our fits"));
  fields.Add(Integer("threads", &o->threads, AtLeast(0), "of each fit, and of the peer"));
  fields.Add(Number("max_seconds", &o->max_seconds, Above(0.0), "time for each of our fits"));
  fields.Add(Integer("lm_iterations", &o->lm_iterations, AtLeast(0),
                     "iterations of lm and ceres_lm, at most"));
  fields.Add(Integer("lbfgs_iterations", &o->lbfgs_iterations, AtLeast(0),
                     "iterations of ceres_lbfgs and ceres_lbfgs_absolute, at most"));
  fields.Add(OverridingInteger("adam_epochs", &o->adam_epochs, AtLeast(0), "epochs of adam"));
  fields.Add(
      OverridingInteger("adam_samples", &o->adam_samples, AtLeast(1), "training samples of adam"));
  fields.Add(Integer("heldout_samples", &o->heldout_samples, AtLeast(1),
                     "held-out samples that the error of a finished fit is measured on"));
  fields.Add(
      Text("peer", &o->peer,
           "script of another implementation, run as experiments/lib/peer.h says; '': none"));
  fields.Add(Text("peer_python", &o->peer_python, "interpreter that runs the script"));
  fields.Add(Text("peer_flags", &o->peer_flags, "more flags for the script, separated by blanks"));
  fields.Add(Text("sgd", &o->sgd, kSgdHelp));
  return fields;
}

// What a name in --solvers stands for.
struct SolverSetting {
  const char* solver;
  Loss loss;
};

constexpr NameTable<SolverSetting, 5> kSettings = {
    {{"lm", {"lm", Loss::kSoftL1}},
     {"ceres_lm", {"ceres_lm", Loss::kSoftL1}},
     {"ceres_lbfgs", {"ceres_lbfgs", Loss::kSoftL1}},
     {"ceres_lbfgs_absolute", {"ceres_lbfgs", Loss::kAbsolute}},
     {"adam", {"adam", Loss::kAbsolute}}}};

// Adam's is the published recipe.
FitSetup AdamSetup(const Options& options) {
  FitSetup setup = ShippedProblem(options.method == Method::kNbrdf ? "nbrdf_adam" : "pbnbrdf_adam");
  if (options.adam_epochs) setup.options.schedule.max_iterations = *options.adam_epochs;
  if (options.adam_samples) setup.problem.sampling.samples = *options.adam_samples;
  return setup;
}

FitSetup Setup(const Options& options, const SolverSetting& setting, const std::vector<int>& hidden,
               int seed) {
  FitSetup setup;
  if (setting.solver == std::string_view("adam")) {
    setup = AdamSetup(options);
  } else {
    if (options.method == Method::kPbnbrdf) setup = ShippedProblem("pbnbrdf");
    const bool is_lbfgs = setting.solver == std::string_view("ceres_lbfgs");
    setup.options.schedule.max_iterations =
        is_lbfgs ? options.lbfgs_iterations : options.lm_iterations;
  }
  setup.problem.terms.loss = setting.loss;
  setup.problem.network.hidden = hidden;
  setup.problem.sampling.seed = static_cast<std::uint64_t>(seed);
  setup.options.solver = setting.solver;
  setup.options.schedule.max_seconds = options.max_seconds;
  setup.options.threads = options.threads;
  ValidateFit(setup.problem, setup.options);
  return setup;
}

// What is asked for, all of it checked before the first fit.
struct Plan {
  Options options;
  std::vector<MaterialSource> materials;
  std::vector<std::pair<std::string, SolverSetting>> solvers;
  std::optional<Peer> peer;
};

std::optional<Peer> PlanPeer(const Options& options) {
  if (options.peer.empty()) return std::nullopt;
  const std::string method(NameOf(kMethods, options.method));
  Peer peer = {options.peer_python, options.peer, method, options.threads, {}};
  for (const std::string& flag : Split(options.peer_flags, ' ')) {
    if (!flag.empty()) peer.more_flags.push_back(flag);
  }
  const std::string why_not = peer.WhyUnavailable();
  if (why_not.empty()) return peer;
  std::fprintf(stderr, "without the peer: %s\n", why_not.c_str());
  return std::nullopt;
}

Plan MakePlan(const Options& options, const Arguments& arguments) {
  Plan plan = {options, ParseMaterials(arguments, kDefaultMaterials, options.sgd), {}, {}};
  if (options.hidden.empty()) Fail("hidden: names no network, as 21,21 does");
  for (const std::string& name : options.solvers) {
    plan.solvers.emplace_back(name, ParseName(kSettings, "solvers", name));
    for (const std::vector<int>& hidden : options.hidden) {
      Setup(options, plan.solvers.back().second, hidden, 1);
    }
  }
  plan.peer = PlanPeer(options);
  return plan;
}

class Comparison {
 public:
  Comparison(const Plan& plan, const Output& output)
      : plan_(plan),
        output_(output),
        log_(output.Path("solver_comparison.csv"),
             {"material", "material_class", "solver", "hidden", "seed", "iteration", "seconds",
              "cost", "heldout_error"}) {}

  void RunMaterial(const MaterialSource& material) {
    const MerlBrdf table = MerlBrdf::Tabulate(*OpenBrdf(material.source));
    if (plan_.peer) RunPeer(material, table);
    for (const std::vector<int>& hidden : plan_.options.hidden) {
      for (const auto& [name, setting] : plan_.solvers) {
        for (int seed : plan_.options.seeds) {
          RunFit(material, table, name, Setup(plan_.options, setting, hidden, seed));
        }
      }
    }
  }

  void Report() const {
    output_.WriteReport("solver_comparison", Preface() + ComparisonMarkdown(fits_, peers_));
    output_.WriteFigure("solver_comparison", ComparisonFigure(fits_, peers_));
  }

 private:
  // How the numbers came about, and what failed.
  std::string Preface() const {
    std::string text =
        StrCat("Method ", NameOf(kMethods, plan_.options.method), ", ", plan_.options.threads,
               " threads, seeds ", Joined(plan_.options.seeds, ","),
               "; error: mean |eq. 6| on held-out samples.");
    if (!peers_.empty()) {
      text +=
          " The peer's error is that of its network on the same samples as ours; 'its own figure' "
          "is on its own samples, with its own interpolation of the table. Times as fast: the "
          "peer's seconds over the seconds in which ours reaches its error. Times as accurate: its "
          "error over ours when its time has passed.";
    }
    return text + " " + log_.FailuresMarkdown();
  }

  double HeldoutError(const MerlBrdf& table, const NeuralBrdf& network) const {
    return MeasureErrors(HeldOutSamples(table, plan_.options.heldout_samples, /*seed=*/1), network)
        .mean_abs_log_error;
  }

  void RunFit(const MaterialSource& material, const MerlBrdf& table, const std::string& solver,
              FitSetup setup) {
    FitRecord record;
    record.material = material.name;
    record.solver = solver;
    record.hidden = HiddenName(setup.problem.network.hidden);
    record.seed = static_cast<int>(setup.problem.sampling.seed);
    const std::string what =
        StrCat(record.material, ", ", solver, ", ", record.hidden, ", seed ", record.seed, ": ");
    setup.options.on_iteration = [&](const FitProgress& progress) {
      record.trace.push_back(progress);
      return true;
    };
    try {
      const Fit fit = FitBrdf(table, setup.problem, setup.options);
      record.seconds = fit.summary.seconds;
      record.error = HeldoutError(table, fit.network);
    } catch (const Error& error) {
      log_.AddFailure(what + error.what());
      return;
    }
    std::fprintf(stderr, "%s%.3g in %.3g s\n", what.c_str(), record.error, record.seconds);
    LogTrace(material, solver, record.hidden, record.seed, record.trace);
    fits_.push_back(std::move(record));
  }

  // Where the peer fails, this material alone has no columns of its.
  void RunPeer(const MaterialSource& material, const MerlBrdf& table) {
    const std::string table_file = output_.Path("solver_comparison_table.binary");
    const std::string folder = output_.Path("solver_comparison_peer");
    table.Write(table_file);
    try {
      std::filesystem::create_directories(folder);
      PeerResult result = plan_.peer->Train(table_file, folder);
      if (result.network) result.error = HeldoutError(table, *result.network);
      LogTrace(material, "peer", kPeerHidden, 0, result.trace);
      std::fprintf(stderr, "%s, peer: %.3g in %.3g s\n", material.name.c_str(), result.error,
                   result.seconds);
      peers_[material.name] = result;
    } catch (const Error& error) {
      std::fprintf(stderr, "%s, peer: %s\n", material.name.c_str(), error.what());
    }
    std::filesystem::remove(table_file);
    std::filesystem::remove_all(folder);
  }

  void LogTrace(const MaterialSource& material, const std::string& solver,
                const std::string& hidden, int seed, const std::vector<FitProgress>& trace) {
    for (const FitProgress& p : trace) {
      log_.AddRow({material.name, material.material_class, solver, hidden, StrCat(seed),
                   StrCat(p.iteration), FormatNumber(p.seconds), FormatNumber(p.cost),
                   FormatNumber(p.heldout_error)});
    }
  }

  const Plan& plan_;
  const Output& output_;
  FitLog log_;
  std::vector<FitRecord> fits_;
  PeerRecords peers_;
};

void Run(const Options& options, const Arguments& arguments, const Output& output) {
  const Plan plan = MakePlan(options, arguments);
  Comparison comparison(plan, output);
  for (const MaterialSource& material : plan.materials) comparison.RunMaterial(material);
  comparison.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::FieldsOf, pbnbrdf::Run);
}
