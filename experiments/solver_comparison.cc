// solver_comparison.cc: held-out error against time of every solver, and of another implementation.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "base/text.h"
#include "comparison.h"
#include "experiment.h"
#include "pbnbrdf/base/error.h"
#include "pbnbrdf/metrics/brdf_metrics.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/problem/sampling.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/open_brdf.h"

DEFINE_string(method, "nbrdf",
              "nbrdf: as the fit's defaults have it | pbnbrdf: with the chromaticity term too; for "
              "adam and the peer the published set-up of that name");
DEFINE_string(solvers, "tiny_lm,lm,lbfgs,lbfgs_absolute,adam",
              "any of these; lbfgs_absolute minimises the papers' own sum");
DEFINE_string(hidden, "21,21", "hidden layers' sizes of each network: '8,8,8 21,21 64,64,64'");
DEFINE_string(seeds, "1", "seeds of our fits");
DEFINE_int32(threads, 2, "of each fit, the peer's too");
DEFINE_double(max_seconds, 60.0, "of each of our fits");
DEFINE_int32(lm_iterations, pbnbrdf::FitOptions{}.max_iterations, "of tiny_lm and lm");
DEFINE_int32(lbfgs_iterations, 10000, "of lbfgs and lbfgs_absolute");
DEFINE_int32(adam_epochs, 100, "of adam");
DEFINE_uint64(adam_samples, 640000, "training samples of adam");
DEFINE_uint64(heldout_samples, 200000, "held-out samples of a fit's last error");
DEFINE_string(peer, "", "script of another implementation (peer.h); '': none");
DEFINE_string(peer_python, "/usr/bin/python3", "interpreter that runs it");
DEFINE_string(peer_flags, "", "more flags for it, separated by blanks");

namespace pbnbrdf {
namespace {

constexpr char kUsage[] =
    R"(solver_comparison: held-out error against time of every solver, beside another implementation.

  solver_comparison --out_dir=results builtin:satin-gold metal=sgd:parameters.csv#chrome-steel
  solver_comparison --out_dir=results --peer=peer_train.py --seeds=1,2,3 merl/*.binary

The arguments are materials, anything that 'pbnbrdf fit --material' takes, CLASS= in front of it if
wanted; without any, a few built-in ones. Each is tabulated as a MERL file, which all fit, one after
the other. Writes solver_comparison.csv, with a row for each iteration, solver_comparison.md and
solver_comparison.svg.
)";

struct SolverSetting {
  Solver solver;
  Loss loss;
};

constexpr NameTable<SolverSetting, 5> kSettings = {
    {{"tiny_lm", {Solver::kTinyLm, Loss::kSoftL1}},
     {"lm", {Solver::kLm, Loss::kSoftL1}},
     {"lbfgs", {Solver::kLbfgs, Loss::kSoftL1}},
     {"lbfgs_absolute", {Solver::kLbfgs, Loss::kAbsolute}},
     {"adam", {Solver::kAdam, Loss::kAbsolute}}}};

enum class Method { kNbrdf, kPbnbrdf };

constexpr NameTable<Method, 2> kMethods = {
    {{"nbrdf", Method::kNbrdf}, {"pbnbrdf", Method::kPbnbrdf}}};

struct FitSetUp {
  FitProblem problem;
  FitOptions options;
};

// The published problem: problems/nbrdf_adam.flags and pbnbrdf_adam.flags.
FitProblem PublishedProblem(Method method) {
  FitProblem problem;
  problem.activation = Activation::kRelu;
  problem.initialization = Initialization::kNbrdf;
  problem.sampling = Sampling::kUniform;
  problem.samples = FLAGS_adam_samples;
  problem.encoding = method == Method::kNbrdf ? Encoding::kCartesian : Encoding::kReciprocal;
  problem.chromaticity_weight = method == Method::kNbrdf ? 0.0 : 1.0;
  problem.energy_weight = method == Method::kNbrdf ? 0.0 : 1.0;
  problem.energy_theta = 32;
  problem.energy_phi = 16;
  return problem;
}

int Iterations(Solver solver) {
  if (solver == Solver::kAdam) return FLAGS_adam_epochs;
  return solver == Solver::kLbfgs ? FLAGS_lbfgs_iterations : FLAGS_lm_iterations;
}

FitSetUp SetUp(const SolverSetting& setting, Method method, const std::vector<int>& hidden,
               std::size_t seed) {
  FitSetUp set_up;
  if (setting.solver == Solver::kAdam) {
    set_up.problem = PublishedProblem(method);
  } else {
    set_up.problem.chromaticity_weight = method == Method::kNbrdf ? 0.0 : 0.1;
  }
  set_up.problem.loss = setting.loss;
  set_up.problem.hidden = hidden;
  set_up.problem.seed = seed;
  set_up.options.solver = setting.solver;
  set_up.options.max_iterations = Iterations(setting.solver);
  set_up.options.max_seconds = FLAGS_max_seconds;
  set_up.options.threads = FLAGS_threads;
  ValidateFit(set_up.problem, set_up.options);
  return set_up;
}

// What is asked for, all of it checked before the first fit.
struct Plan {
  std::vector<MaterialSource> materials;
  std::vector<std::pair<std::string, SolverSetting>> solvers;
  std::vector<std::vector<int>> networks;
  std::vector<std::size_t> seeds;
  Method method;
  Peer peer;
  bool has_peer = false;
};

void PlanPeer(Plan* plan) {
  plan->peer = {FLAGS_peer_python, FLAGS_peer, FLAGS_method, FLAGS_threads, {}};
  for (const std::string& flag : Split(FLAGS_peer_flags, ' ')) {
    if (!flag.empty()) plan->peer.more_flags.push_back(flag);
  }
  if (FLAGS_peer.empty()) return;
  const std::string why_not = plan->peer.WhyUnavailable();
  plan->has_peer = why_not.empty();
  if (!plan->has_peer) std::fprintf(stderr, "left out, the peer: %s\n", why_not.c_str());
}

Plan MakePlan(const std::vector<std::string>& materials) {
  Plan plan;
  const std::vector<std::string> few = {"builtin:ivory-computer-plastic",
                                        "builtin:red-satin-plastic", "builtin:satin-gold"};
  plan.materials = ParseMaterials(materials.empty() ? few : materials);
  for (const std::string& name : Split(FLAGS_solvers, ',')) {
    plan.solvers.emplace_back(name, ParseName(kSettings, "solvers", name));
  }
  plan.networks = ParseNetworks("hidden", FLAGS_hidden);
  plan.seeds = ParseCounts("seeds", FLAGS_seeds);
  plan.method = ParseName(kMethods, "method", FLAGS_method);
  for (const auto& [name, setting] : plan.solvers) {
    for (const std::vector<int>& hidden : plan.networks) SetUp(setting, plan.method, hidden, 1);
  }
  PlanPeer(&plan);
  return plan;
}

class Comparison {
 public:
  explicit Comparison(const Plan& plan)
      : plan_(plan), csv_path_(OutputPath("solver_comparison.csv")), csv_(csv_path_) {
    csv_ << CsvLine({"material", "material_class", "solver", "hidden", "seed", "iteration",
                     "seconds", "cost", "heldout_error"});
  }

  void RunMaterial(const MaterialSource& material) {
    const MerlBrdf table = MerlBrdf::Tabulate(*OpenBrdf(material.source));
    if (plan_.has_peer) RunPeer(material, table);
    for (const std::vector<int>& hidden : plan_.networks) {
      for (const auto& [name, setting] : plan_.solvers) {
        for (std::size_t seed : plan_.seeds) {
          RunFit(material, table, name, SetUp(setting, plan_.method, hidden, seed));
        }
      }
    }
  }

  void Report() const {
    WriteReport("solver_comparison", Preface() + ComparisonMarkdown(fits_, peers_));
    WriteFigure("solver_comparison", ComparisonFigure(fits_, peers_));
  }

 private:
  // How the numbers came about, and what failed.
  std::string Preface() const {
    std::string text = StrCat("Method ", FLAGS_method, ", ", FLAGS_threads, " threads, seeds ",
                              FLAGS_seeds, "; error: mean |eq. 6| on held-out samples.");
    if (!peers_.empty()) {
      text +=
          " The peer's error is its network's on the same samples, and its own figure the one on "
          "its own samples and interpolation. Times as fast: the peer's seconds over ours to its "
          "error. Times as accurate: its error over ours after its seconds.";
    }
    text += StrCat(" Failed fits: ", failures_.size(), ".\n\n");
    for (const std::string& failure : failures_) text += "- " + failure + "\n";
    return text + (failures_.empty() ? "" : "\n");
  }

  static double HeldoutError(const MerlBrdf& table, const NeuralBrdf& network) {
    return MeasureErrors(HeldOutSamples(table, FLAGS_heldout_samples, /*seed=*/1), network)
        .mean_abs_log_error;
  }

  void RunFit(const MaterialSource& material, const MerlBrdf& table, const std::string& solver,
              FitSetUp set_up) {
    FitRecord record;
    record.material = material.name;
    record.solver = solver;
    record.hidden = HiddenName(set_up.problem.hidden);
    record.seed = static_cast<int>(set_up.problem.seed);
    const std::string what =
        StrCat(record.material, ", ", solver, ", ", record.hidden, ", seed ", record.seed, ": ");
    set_up.options.on_iteration = [&](const FitProgress& progress) {
      record.trace.push_back(progress);
      return true;
    };
    try {
      const Fit fit = FitBrdf(table, set_up.problem, set_up.options);
      record.seconds = fit.summary.seconds;
      record.error = HeldoutError(table, fit.network);
    } catch (const Error& error) {
      failures_.push_back(what + error.what());
      std::fprintf(stderr, "%s\n", failures_.back().c_str());
      return;
    }
    std::fprintf(stderr, "%s%.3g in %.3g s\n", what.c_str(), record.error, record.seconds);
    WriteTrace(material, solver, record.hidden, set_up.problem.seed, record.trace);
    fits_.push_back(std::move(record));
  }

  // A failure costs the peer's columns of this material only.
  void RunPeer(const MaterialSource& material, const MerlBrdf& table) {
    const std::string table_file = OutputPath("solver_comparison_table.binary");
    const std::string folder = OutputPath("solver_comparison_peer");
    table.Write(table_file);
    try {
      std::filesystem::create_directories(folder);
      PeerResult result = plan_.peer.Train(table_file, folder);
      if (result.network) result.error = HeldoutError(table, *result.network);
      WriteTrace(material, "peer", kPeerHidden, 0, result.trace);
      std::fprintf(stderr, "%s, peer: %.3g in %.3g s\n", material.name.c_str(), result.error,
                   result.seconds);
      peers_[material.name] = result;
    } catch (const Error& error) {
      std::fprintf(stderr, "%s, peer: %s\n", material.name.c_str(), error.what());
    }
    std::filesystem::remove(table_file);
    std::filesystem::remove_all(folder);
  }

  // At once, so that a long run that is stopped has left its rows.
  void WriteTrace(const MaterialSource& material, const std::string& solver,
                  const std::string& hidden, std::size_t seed,
                  const std::vector<FitProgress>& trace) {
    for (const FitProgress& p : trace) {
      csv_ << CsvLine({material.name, material.material_class, solver, hidden, StrCat(seed),
                       StrCat(p.iteration), FormatNumber(p.seconds), FormatNumber(p.cost),
                       FormatNumber(p.heldout_error)});
    }
    if (!csv_.flush()) Fail(csv_path_, ": can't be written");
  }

  const Plan& plan_;
  std::string csv_path_;
  std::ofstream csv_;
  std::vector<FitRecord> fits_;
  PeerRecords peers_;
  std::vector<std::string> failures_;
};

void Run(const std::vector<std::string>& materials) {
  const Plan plan = MakePlan(materials);
  Comparison comparison(plan);
  for (const MaterialSource& material : plan.materials) comparison.RunMaterial(material);
  comparison.Report();
}

}  // namespace
}  // namespace pbnbrdf

int main(int argc, char** argv) {
  return pbnbrdf::RunExperiment(argc, argv, pbnbrdf::kUsage, pbnbrdf::Run);
}
