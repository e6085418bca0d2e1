// Runs the programs of experiments/ with tiny settings.

#include <map>
#include <set>

#include "base/text.h"
#include "experiments/run_experiment.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr char kTraceHeader[] =
    "material,material_class,solver,hidden,seed,iteration,seconds,cost,heldout_error";

const std::vector<std::string> kTinyComparison = {
    "--threads=1",           "--lm_iterations=2", "--lbfgs_iterations=2",
    "--adam_epochs=1",       "--hidden=3 2,2",    "--adam_samples=1000",
    "--heldout_samples=500", "--seeds=1,2",       "metal=builtin:satin-gold"};

// Stands for an interpreter with torch and for the script that it would run.
void WriteFakePython(const std::string& path) {
  WriteBytes(path, R"(#!/bin/sh
test "$1" = -c && exit 0
while test $# -gt 0; do
  case $1 in --material) table=$2 ;; --trace) trace=$2 ;; --method) method=$2 ;; esac
  shift
done
test -s "$table" && test "$method" = pbnbrdf || exit 1
printf 'epoch,seconds,train_loss,test_loss\n1,0.5,9,8\n2,1,7,6\n' > "$trace"
echo '{"test_loss": 6, "train_seconds": 1}'
)");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

TEST(SolverComparison, WritesTraceTableAndFigure) {
  const TemporaryFolder folder;
  const ProgramResult run = RunIn(folder, "solver_comparison", kTinyComparison);
  ASSERT_EQ(run.status, 0);
  const auto rows = ReadRows(folder / "results/solver_comparison.csv", kTraceHeader);
  for (const char* solver : {"lm", "ceres_lm", "ceres_lbfgs", "ceres_lbfgs_absolute", "adam"}) {
    EXPECT_GE(
        std::count_if(rows.begin(), rows.end(), [&](const auto& r) { return r[2] == solver; }),
        4)  // two networks, two seeds
        << solver;
    EXPECT_THAT(run.output, HasSubstr(StrCat("### ", solver, ", 2-2 hidden units")));
  }
  for (const auto& row : rows) {
    EXPECT_EQ(row[0], "satin-gold");
    EXPECT_EQ(row[1], "metal");
    for (std::size_t c = 4; c < row.size(); ++c) EXPECT_GE(ParseNumber("cell", row[c]), 0.0);
  }
  EXPECT_THAT(run.output, Not(HasSubstr("peer")));
  EXPECT_THAT(run.output, HasSubstr("Failed fits: 0."));
  EXPECT_EQ(Read(folder / "results/solver_comparison.md"), run.output);
  ExpectFigure(folder / "results/solver_comparison.svg");
}

TEST(SolverComparison, RunsThePeerOnTheSameTable) {
  const TemporaryFolder folder;
  WriteFakePython(folder / "python");
  WriteBytes(folder / "peer.py", "");
  std::vector<std::string> flags = kTinyComparison;
  flags.insert(flags.end(), {"--solvers=lm", "--method=pbnbrdf", "--peer=" + (folder / "peer.py"),
                             "--peer_python=" + (folder / "python")});
  const ProgramResult run = RunIn(folder, "solver_comparison", flags);
  ASSERT_EQ(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("times as fast"));
  const auto rows = ReadRows(folder / "results/solver_comparison.csv", kTraceHeader);
  EXPECT_EQ(rows[1], (std::vector<std::string>{"satin-gold", "metal", "peer", "21-21", "0", "2",
                                               "1", "7", "6"}));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/solver_comparison_table.binary"));
}

TEST(SolverComparison, DoesWithoutThePeerIfItCantRun) {
  const TemporaryFolder folder;
  std::vector<std::string> flags = kTinyComparison;
  flags.insert(flags.end(), {"--solvers=lm", "--peer=" + (folder / "absent.py")});
  const ProgramResult run = RunIn(folder, "solver_comparison", flags);
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.output, Not(HasSubstr("peer")));
}

// A MERL table with a single valid bin: too little to draw samples from.
void WriteEmptyTable(const std::string& path) {
  constexpr std::int32_t kSizes[] = {90, 90, 180};
  std::vector<double> planes(3 * 90 * 90 * 180, -1.0);
  for (std::size_t channel = 0; channel < 3; ++channel) planes[channel * planes.size() / 3] = 1.0;
  WriteBytes(path, std::string(reinterpret_cast<const char*>(kSizes), sizeof(kSizes)) +
                       std::string(reinterpret_cast<const char*>(planes.data()),
                                   planes.size() * sizeof(double)));
}

TEST(SolverComparison, CountsFitsThatFail) {
  const TemporaryFolder folder;
  WriteEmptyTable(folder / "empty.binary");
  const ProgramResult run =
      RunIn(folder, "solver_comparison", {"--solvers=lm", folder / "empty.binary"});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("Failed fits: 1.\n\n- empty, lm, 21-21, seed 1: "));
}

TEST(SolverComparison, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag : {"--solvers=sgd", "--method=other", "--hidden=a", "--seeds=0"}) {
    EXPECT_EQ(RunIn(folder, "solver_comparison", {flag}).status, 1) << flag;
  }
  EXPECT_EQ(
      RunIn(folder, "solver_comparison", {"builtin:satin-gold", "x=builtin:satin-gold"}).status, 1);
  EXPECT_EQ(RunIn(folder, "solver_comparison", {"absent.binary"}).status, 1);
}

const std::vector<std::string> kTinyAblation = {"--max_iterations=3", "--samples=300",
                                                "--heldout_samples=500", "--threads=1"};

ProgramResult RunAblation(const TemporaryFolder& folder, std::vector<std::string> flags) {
  flags.insert(flags.begin(), kTinyAblation.begin(), kTinyAblation.end());
  return RunIn(folder, "ablation", flags);
}

constexpr char kAblationHeader[] =
    "table,set_up,material,material_class,seed,iterations,seconds,mean_abs_log_error,"
    "chromaticity_error,hrl,hcl,max_directional_albedo,eal,delta_e_mean,delta_e_p95,"
    "dark_hue_chroma_mean,dark_hue_chroma_p95,dark_samples";

TEST(Ablation, WritesEveryFitAndTheTables) {
  const TemporaryFolder folder;
  const ProgramResult run = RunAblation(
      folder,
      {"--seeds=2", "--jobs=2", "metal=builtin:satin-gold", "diffuse=builtin:wall-plaster"});
  ASSERT_EQ(run.status, 0);
  const std::string csv = Read(folder / "results/ablation.csv");
  EXPECT_THAT(csv, testing::StartsWith(std::string(kAblationHeader) + "\n"));
  const auto count = [&](const std::string& text) {
    std::size_t found = 0;
    for (std::size_t at = csv.find(text); at != std::string::npos; at = csv.find(text, at + 1)) {
      ++found;
    }
    return found;
  };
  EXPECT_EQ(count("\n1,"), 6u);  // three encodings, two materials
  EXPECT_EQ(count("\n2,"), 3u);  // gold itself and two set-ups; plaster dissipates
  EXPECT_EQ(count("\n3,"), 6u);  // three weights
  EXPECT_EQ(count("\n1,reciprocal encoding,satin-gold,metal,2,"), 1u);
  for (const char* text :
       {"Failed fits: 0.", "## Reciprocity", "HRL x 10^3, median", "| nbrdf ", "14729", "## Energy",
        "| the material itself", "| log + energy", " of 1 ", "## Chromaticity",
        "| log + 0.1 chromaticity", "log + 1 chromaticity against log: dark hue/chroma p95 falls",
        "| metal ", "LPIPS"}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
  EXPECT_EQ(Read(folder / "results/ablation.md"), run.output);
}

TEST(Ablation, OtherSourcesAreScaledForTheEnergyTable) {
  const TemporaryFolder folder;
  WriteBytes(folder / "sgd.csv",
             "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n"
             "grey,,r,0.1,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "grey,,g,0.2,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "grey,,b,0.2,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n");
  const ProgramResult run =
      RunAblation(folder, {"--tables=2", "--sgd=" + (folder / "sgd.csv"), "other=sgd:grey"});
  ASSERT_EQ(run.status, 0);
  EXPECT_THAT(run.output, testing::ContainsRegex("the material itself +\\| +0.9[89][0-9]* "));
  EXPECT_THAT(run.output, Not(HasSubstr("## Reciprocity")));
}

TEST(Ablation, CountsFitsThatFail) {
  const TemporaryFolder folder;
  WriteEmptyTable(folder / "empty.binary");
  const ProgramResult run =
      RunAblation(folder, {"--tables=1", "--seeds=1,2", folder / "empty.binary"});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("Failed fits: 6.\n\n- table 1, empty, nbrdf, seed 1: "));
  EXPECT_THAT(run.output, HasSubstr("\n- table 1, empty, nbrdf, seed 2: "));
}

TEST(Ablation, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag :
       {"--tables=5", "--tables=0", "--seeds=0", "--base=other", "--chromaticity_weights=-1",
        "--chromaticity_weights=x", "--heldout_samples=0", "--scale_to_albedo=0", "--samples=0",
        "--jobs=0", "--materials=builtin:satin-gold", "sgd:brass", "absent.binary"}) {
    EXPECT_EQ(RunAblation(folder, {"--tables=1,2,3,4", flag}).status, 1) << flag;
  }
  EXPECT_EQ(RunAblation(folder, {"builtin:satin-gold", "x=builtin:satin-gold"}).status, 1);
}

const std::vector<std::string> kTinyModels = {"--samples=300",         "--starts=2",
                                              "--network_samples=300", "--network_iterations=3",
                                              "--heldout_samples=500", "--hidden=3,3"};

TEST(Models, WritesEveryFitAndTheTables) {
  const TemporaryFolder folder;
  std::vector<std::string> flags = kTinyModels;
  flags.insert(flags.end(), {"--models=lambert,phong,ggx", "--lobes=1,2",
                             "metal=builtin:satin-gold", "builtin:blue-plastic"});
  const ProgramResult run = RunIn(folder, "models", flags);
  ASSERT_EQ(run.status, 0);
  const std::string csv = Read(folder / "results/models.csv");
  EXPECT_THAT(csv, testing::StartsWith("material,kind,method,parameters,iterations,seconds,"
                                       "mean_abs_log_error,rmse,delta_e_mean\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 6);
  EXPECT_THAT(csv, HasSubstr("satin-gold,builtin,\"ggx, 2 lobes\",19,"));
  EXPECT_THAT(csv, HasSubstr("satin-gold,builtin,lambert,3,"));
  for (const char* text : {"Failed fits: 0.", "## By material", "| satin-gold ", "| blue-plastic ",
                           "## By method, builtin", "| phong, 1 lobe ", "| network 3-3 "}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
  EXPECT_EQ(Read(folder / "results/models.md"), run.output);
}

TEST(Models, DefaultMaterialsAreTheBuiltinOnes) {
  const TemporaryFolder folder;
  const ProgramResult run = RunIn(
      folder, "models",
      {"--models=lambert", "--hidden=", "--samples=50", "--starts=1", "--heldout_samples=50"});
  ASSERT_EQ(run.status, 0);
  EXPECT_THAT(run.output, testing::StartsWith("21 materials. "));
}

TEST(Models, CountsFitsThatFail) {
  const TemporaryFolder folder;
  WriteEmptyTable(folder / "empty.binary");
  std::vector<std::string> flags = kTinyModels;
  flags.insert(flags.end(), {"--models=ggx", "--lobes=1", folder / "empty.binary"});
  const ProgramResult run = RunIn(folder, "models", flags);
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.output, HasSubstr("Failed fits: 2.\n\n- empty, ggx, 1 lobe: "));
}

TEST(Models, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag :
       {"--models=none", "--lobes=3", "--lobes=0", "--hidden=a", "--samples=0", "--starts=0",
        "--sampling=other", "--heldout_samples=0", "sgd:brass", "absent.binary"}) {
    EXPECT_EQ(RunIn(folder, "models", {flag}).status, 1) << flag;
  }
}

TEST(Noise, HasARowForEachFormAndNoise) {
  const TemporaryFolder folder;
  const std::vector<std::string> flags = {"--additive=0.01",     "--multiplicative=0.1",
                                          "--measurements=2000", "--samples=500",
                                          "--max_seconds=1",     "lambert:rho_d=0.3"};
  const ProgramResult run = RunIn(folder, "noise", flags);
  ASSERT_EQ(run.status, 0);
  for (const char* form : {"table", "list "}) {
    for (const char* noise : {"none ", "additive 0.01 ", "multiplicative 0.1 "}) {
      EXPECT_THAT(run.output, HasSubstr(StrCat("| lambert:rho_d=0 | ", form))) << form;
      EXPECT_THAT(run.output, HasSubstr(StrCat("| ", noise))) << noise;
    }
  }
  EXPECT_THAT(run.output, testing::ContainsRegex("in [0-4] of 4 rows with noise"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/noise.binary"));
  EXPECT_EQ(Read(folder / "results/noise.md"), run.output);
}

TEST(Noise, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag : {"--additive=-1", "--multiplicative=x", "--forms=other",
                           "--measurements=0", "--samples=1", "absent.binary"}) {
    EXPECT_EQ(RunIn(folder, "noise", {flag, "builtin:blue-plastic"}).status, 1) << flag;
  }
}

TEST(Prior, ComparesWhatKnowsADatabaseWithWhatDoesNot) {
  const TemporaryFolder folder;
  WriteBytes(folder / "few.csv",
             "# isotropic\ntheta_i,phi_i,theta_o,phi_o,value\n0.1,0,0.2,3,0.5\n0.3,0,0.2,2,0.25\n");
  const ProgramResult run =
      RunIn(folder, "prior",
            {"--database=builtin:*-plastic;builtin:*paper;builtin:plastic-laminate", "--hold_out=3",
             "--counts=4", "--components=3", "--code_size=2", "--training_iterations=3",
             "--hidden=4", "--encoding=reciprocal", "--samples=500", "--max_seconds=0.3",
             "--measured=" + (folder / "few.csv")});
  ASSERT_EQ(run.status, 0);
  for (const char* text : {"| Nielsen's method |", "| fit alone |", "| 4 planned ", "| scan ",
                           "| few ", "| 16 of a file |"}) {
    EXPECT_THAT(run.output, HasSubstr(text));
  }
  EXPECT_EQ(Read(folder / "results/prior.md"), run.output);
}

TEST(Prior, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  EXPECT_EQ(RunIn(folder, "prior", {}).status, 1);
  EXPECT_EQ(RunIn(folder, "prior", {"--database=builtin:*-plastic", "--counts=x"}).status, 1);
}

constexpr char kStabilityHeader[] =
    "run,material,stress,solver,loss,terms,encoding,precision,activation,initialization,sampling,"
    "seed,outcome,message,non_finite,termination,iterations,restarts,failed_factorizations,"
    "rejected_steps,cost,error,gradient_error,directions_resolved,directions_unresolved";

TEST(Stability, WritesARowForEachRunAndTables) {
  const TemporaryFolder folder;
  const ProgramResult run =
      RunIn(folder, "stability", {"--runs=30", "--max_iterations=3", "--samples=100", "--jobs=2"});
  ASSERT_EQ(run.status, 0);
  const auto rows = ReadRows(folder / "results/stability.csv", kStabilityHeader);
  ASSERT_EQ(rows.size(), 30u);
  std::set<std::string> runs;
  for (const auto& row : rows) {
    runs.insert(row[0]);
    EXPECT_THAT(row[12], testing::AnyOf("ok", "error")) << row[13];
    EXPECT_NE(row[13], "");
    EXPECT_LT(ParseNumber("gradient_error", row[22]), 1e-5) << "run " << row[0];
  }
  EXPECT_EQ(runs.size(), 30u);
  EXPECT_THAT(run.output, HasSubstr("### By stress"));
  EXPECT_THAT(run.output, HasSubstr("### Errors by kind"));
  EXPECT_EQ(Read(folder / "results/stability.md"), run.output);
}

TEST(Stability, ACrashCostsNoOtherRun) {
  const TemporaryFolder folder;
  const ProgramResult run =
      RunIn(folder, "stability",
            {"--runs=12", "--max_iterations=1", "--samples=50", "--jobs=1", "--crash_at=4"});
  ASSERT_EQ(run.status, 0);
  const auto rows = ReadRows(folder / "results/stability.csv", kStabilityHeader);
  ASSERT_EQ(rows.size(), 12u);
  for (const auto& row : rows) {
    EXPECT_EQ(row[12] == "crash", row[0] == "4");
    EXPECT_NE(row[1], "");  // its material is known even so
  }
  EXPECT_THAT(run.output, HasSubstr("process ended with status #"));
}

TEST(Stability, RejectsWhatItCantDo) {
  const TemporaryFolder folder;
  for (const char* flag : {"--runs=0", "--jobs=0", "--seeds=0", "--sgd=absent.csv"}) {
    EXPECT_EQ(RunIn(folder, "stability", {flag}).status, 1) << flag;
  }
}

TEST(Experiments, HelpNamesTheFlags) {
  const TemporaryFolder folder;
  const std::map<std::string, std::string> flag_of = {{"ablation", "--chromaticity_weights"},
                                                      {"models", "--lobes"},
                                                      {"noise", "--additive"},
                                                      {"prior", "--hold_out"},
#ifdef PBNBRDF_HAS_RENDER
                                                      {"measured", "--left_out"},
                                                      {"picture", "--epochs"},
                                                      {"scene_fit", "--scenes"},
#endif
                                                      {"solver_comparison", "--hidden"},
                                                      {"stability", "--runs"}};
  std::set<std::string> seen;
  for (const std::string& program : Split(PBNBRDF_EXPERIMENT_NAMES, ',')) {
    const ProgramResult run = RunIn(folder, program, {"--help"});
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.output, testing::StartsWith(program + ": "));
    EXPECT_THAT(run.output, HasSubstr("--out_dir"));
    EXPECT_THAT(run.output, Not(HasSubstr("--minloglevel")));
    for (const std::string& line : Split(run.output, '\n')) {
      if (!line.starts_with("--")) {
        EXPECT_LE(line.size(), 104u) << line;
      }
    }
    if (flag_of.count(program) != 0) {
      EXPECT_THAT(run.output, HasSubstr(flag_of.at(program)));
    }
    EXPECT_EQ(RunIn(folder, program, {"--absent=1"}).status, 1) << program;
    seen.insert(program);
  }
  for (const auto& [program, flag] : flag_of) EXPECT_EQ(seen.count(program), 1u) << program;
}

}  // namespace
}  // namespace pbnbrdf
