// The commands prior and plan, and fits that know a database.
#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "pbnbrdf/sources/open_brdf.h"

namespace pbnbrdf {
namespace {

class CliPrior : public Cli {
 protected:
  // Four paints, and what they have in common.
  Result MakePrior(const std::string& flags = "") {
    return Run(
        "prior --material='builtin:*-plastic' --encoding=reciprocal --hidden=6 "
        "--code_size=2 --samples=300 --max_iterations=15 --out=" +
        prior_ + flags);
  }

  const std::string prior_ = Path("plastics.prior");
};

TEST_F(CliPrior, MakesAFileWhoseMaterialsAreSources) {
  const Result made = MakePrior(" --summary=" + Path("s.json"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("2 numbers each; 6-6-3 tanh, reciprocal encoding"));
  EXPECT_THAT(made.out, HasSubstr("certified"));
  const json summary = json::parse(ReadFile(Path("s.json"), 1 << 20));
  ASSERT_GE(summary["materials"].size(), 3u);
  EXPECT_EQ(summary["certified"], summary["materials"].size());
  const std::string name = summary["materials"][0]["name"];

  const Result measure = Run("measure --json --fit=" + prior_ + "#" + name +
                             " --material=builtin:" + name + " --samples=20000");
  ASSERT_EQ(measure.status, 0) << measure.err;
  const json measures = json::parse(measure.out);
  EXPECT_EQ(measures["hrl"], 0.0);
  EXPECT_EQ(measures["mean_abs_log_error"], summary["materials"][0]["mean_abs_log_error"]);

  // What made it makes it again.
  WriteBytes(Path("again.flags"), summary["flags"]);
  ASSERT_EQ(Run("prior --flagfile=" + Path("again.flags") +
                " --quiet --threads=1 --out=" + Path("b.prior"))
                .status,
            0);
  EXPECT_EQ(OpenNetwork(Path("b.prior") + "#" + name).weights(),
            OpenNetwork(prior_ + "#" + name).weights());
  EXPECT_THAT(Run("info " + prior_).err, HasSubstr("name one: " + prior_ + "#"));
  ASSERT_EQ(Run("export --format=c --fit=" + prior_ + "#" + name + " --out=" + Path("a.h")).status,
            0);
}

TEST_F(CliPrior, PlannedDirectionsAreMeasuredAndFitted) {
  ASSERT_EQ(MakePrior().status, 0);
  const Result plan = Run("plan --prior=" + prior_ + " --count=5 --out=" + Path("plan.csv"));
  ASSERT_EQ(plan.status, 0) << plan.err;
  EXPECT_THAT(ReadFile(Path("plan.csv"), 1 << 20),
              StartsWith("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg\n"));
  ASSERT_EQ(Run("eval --material=builtin:red-satin-plastic --directions=" + Path("plan.csv") +
                " --out=" + Path("few.csv"))
                .status,
            0);
  const Result fit =
      Run("fit --material=" + Path("few.csv") + " --prior=" + prior_ +
          " --hidden=6 --samples=2000 --max_iterations=5 --out=" + Path("a.safetensors") +
          " --summary=" + Path("a.json"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("of 5 measurements none is held out"));
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).metadata().at("encoding"), "reciprocal");
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_THAT(std::string(summary["problem"]), HasSubstr("--prior=" + prior_ + "\n"));

  // The next ones, which the first are taken into account for.
  const Result next = Run("plan --prior=" + prior_ + " --count=2 --material=" + Path("few.csv"));
  ASSERT_EQ(next.status, 0) << next.err;
  EXPECT_EQ(std::count(next.out.begin(), next.out.end(), '\n'), 3);
}

TEST_F(CliPrior, PrincipalComponentsAreAPriorToo) {
  const std::string pca = Path("plastics.pca");
  const Result made =
      Run("prior --model=pca --material='builtin:*-plastic' --code_size=2 --out=" + pca);
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("2 numbers for each channel; principal components"));
  EXPECT_THAT(Run("info " + pca + "#red-satin-plastic").out, HasSubstr("MERL table"));
  ASSERT_EQ(Run("plan --prior=" + pca + " --count=3 --out=" + Path("plan.csv")).status, 0);
  ASSERT_EQ(Run("eval --material=builtin:red-satin-plastic --directions=" + Path("plan.csv") +
                " --out=" + Path("few.csv"))
                .status,
            0);
  const Result fit = Run("fit --material=" + Path("few.csv") + " --prior=" + pca + kQuick +
                         "--out=" + Path("a.safetensors"));
  EXPECT_EQ(fit.status, 0) << fit.err;
}

TEST_F(CliPrior, SaysWhatIsWrong) {
  EXPECT_EQ(Run("prior --out=" + prior_).status, 2);
  EXPECT_THAT(Run("prior --material=builtin:spectralon --out=" + prior_).err,
              HasSubstr("at least two materials"));
  EXPECT_THAT(Run("prior --material='builtin:*-plastic' --code_size=200 --out=" + prior_).err,
              HasSubstr("code_size = 200; must be 1 to"));
  EXPECT_THAT(Run("plan --prior=" + Path("none.prior")).err, HasSubstr("none.prior"));
  WriteBytes(Path("text"), "text");
  EXPECT_THAT(Run("fit --material=builtin:spectralon --prior=" + Path("text") + kQuick +
                  "--out=" + Path("a.safetensors"))
                  .err,
              HasSubstr("isn't what pbnbrdf prior writes"));
  ASSERT_EQ(MakePrior(" --quiet").status, 0);
  EXPECT_THAT(Run("plan --prior=" + prior_ + " --material=builtin:spectralon").err,
              HasSubstr("isn't a list of measurements"));
  EXPECT_THAT(Run("plan --prior=" + prior_ + " --max_theta=95").err, HasSubstr("max_theta"));
}

}  // namespace
}  // namespace pbnbrdf
