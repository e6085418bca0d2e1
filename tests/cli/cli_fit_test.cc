// The commands fit and measure, and what they write.
#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

TEST_F(Cli, FitWritesANetworkAndASummaryThatRepeatsIt) {
  const std::string material = "--material=builtin:satin-gold";
  const Result fit = Run("fit " + material + kQuick + "--seed=7 --out=" + Path("a.safetensors") +
                         " --summary=" + Path("a.json") + " --trace=" + Path("a.csv"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(ReadFile(Path("a.csv"), 1 << 20),
              StartsWith("iteration,seconds,cost,heldout_error\n0,"));
  EXPECT_EQ(fit.err, "");
  EXPECT_THAT(fit.out, HasSubstr("mean_abs_log_error"));
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  for (const char* key : {"mean_abs_log_error", "hrl", "hcl", "max_directional_albedo", "cost",
                          "iterations", "restarts", "failed_factorizations", "rejected_steps",
                          "seconds", "seed", "problem", "termination"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  EXPECT_EQ(summary["seed"], 7);
  EXPECT_EQ(summary["hrl"], 0.0);
  EXPECT_EQ(summary["hcl"], 0.0);

  WriteBytes(Path("again.flags"), summary["problem"]);
  const Result again = Run("fit --quiet --flagfile=" + Path("again.flags") +
                           " --threads=1 --out=" + Path("b.safetensors"));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, "");
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights(),
            NeuralBrdf::Read(Path("b.safetensors")).weights());

  const Result info = Run("info " + Path("a.safetensors"));
  EXPECT_THAT(info.out, HasSubstr("neural BRDF 6-5-3 tanh, merl encoding"));
  EXPECT_THAT(info.out, HasSubstr("seed: 7"));
}

TEST_F(Cli, TheEncodingSuitsTheMaterialUnlessItIsGiven) {
  const std::string brass = " --material=builtin:rolled-brass", fit = "fit" + brass + kQuick;
  const Result automatic =
      Run(fit + "--out=" + Path("a.safetensors") + " --summary=" + Path("a.json"));
  ASSERT_EQ(automatic.status, 0) << automatic.err;
  EXPECT_THAT(automatic.out, HasSubstr("anisotropic encoding"));
  EXPECT_THAT(automatic.out, Not(HasSubstr("best isotropic fit")));
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).metadata().at("encoding"), "anisotropic");
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_THAT(std::string(summary["problem"]), HasSubstr("--encoding=anisotropic\n"));
  EXPECT_EQ(summary["hrl"], 0.0);

  // Goes on from that fit, which --init must find fitting with the flag left alone.
  ASSERT_EQ(Run(fit + "--max_iterations=0 --init=" + Path("a.safetensors") +
                " --out=" + Path("b.safetensors"))
                .status,
            0);
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights(),
            NeuralBrdf::Read(Path("b.safetensors")).weights());

  const Result isotropic = Run(fit + "--encoding=merl --out=" + Path("c.safetensors"));
  EXPECT_EQ(isotropic.status, 0) << isotropic.err;
  EXPECT_THAT(isotropic.out, HasSubstr("the material is anisotropic, and this is the best "
                                       "isotropic fit: --encoding=anisotropic gets closer\n"));
  ExpectError("fit --material=builtin:satin-gold --encoding=anisotropic --out=" + Path("out"), 1,
              "builtin:satin-gold: encoding: anisotropic is for anisotropic materials");
}

TEST_F(Cli, AFitGoesOnFromAnother) {
  const std::string fit = "fit --quiet --material=builtin:satin-gold" + std::string(kQuick);
  ASSERT_EQ(Run(fit + "--out=" + Path("a.safetensors")).status, 0);
  const std::string from_a = " --init=" + Path("a.safetensors");
  ASSERT_EQ(Run(fit + "--max_iterations=0 --out=" + Path("b.safetensors") + from_a).status, 0);
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights(),
            NeuralBrdf::Read(Path("b.safetensors")).weights());
  ExpectError(fit + "--encoding=reciprocal --out=" + Path("b.safetensors") + from_a, 1,
              "a.safetensors: a network 6-5-3 tanh, merl encoding; --init needs 6-5-3 tanh, "
              "reciprocal encoding");
  ExpectError(fit + "--out=" + Path("b.safetensors") + " --init=" + Path("none.safetensors"), 1,
              "none.safetensors: no such file");
}

TEST_F(Cli, TheReferencePathFitsToo) {
  const Result fit = Run("fit --material=builtin:satin-gold --solver=autodiff --terms=log" +
                         kQuick + "--samples=50 --out=" + Path("a.safetensors"));
  EXPECT_EQ(fit.status, 0) << fit.err;
}

TEST_F(Cli, ShippedProblemsFit) {
  for (const char* name : {"nbrdf", "reciprocal", "energy", "chromaticity", "pbnbrdf", "best",
                           "nbrdf_adam", "pbnbrdf_adam"}) {
    const std::string flags = StrCat("--flagfile=", PBNBRDF_PROBLEMS, "/", name, ".flags");
    const Result fit = Run("fit " + flags + " --material=builtin:satin-gold --samples=300" +
                           " --max_iterations=2 --out=" + Path("a.safetensors"));
    EXPECT_EQ(fit.status, 0) << name << ": " << fit.err;
  }
}

TEST_F(Cli, OddOutputsAreHandled) {
  const std::string fit = "fit --material=builtin:satin-gold" + kQuick;
  ExpectError(fit + "--out=" + Path("out") + " --summary=" + Path("out"), 2,
              "--out and --summary name the same file");
  ExpectError(fit + "--out=" + Path(std::string(300, 'a')), 1, "cannot write: File name too long");
  ExpectError(fit + "--out=" + Path("out") + " --hidden=256,256 --solver=ceres_lm", 2,
              "--hidden: makes 68355 weights; ceres_lm takes at most 10000");
  // A link stays a link.
  WriteBytes(Path("target"), "old");
  std::filesystem::create_symlink(Path("target"), Path("link"));
  ASSERT_EQ(Run(fit + "--out=" + Path("link")).status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(Path("link")));
  EXPECT_EQ(NeuralBrdf::Read(Path("target")).weights().size(), 53u);
}

TEST_F(Cli, NamesThatAreNotUtf8AreHandled) {
  ASSERT_EQ(
      Run("export --format=merl --material=builtin:satin-gold --out=" + Path("\xff.binary")).status,
      0);
  EXPECT_EQ(Run("fit --material=" + Path("\xff.binary") + kQuick +
                "--out=" + Path("a.safetensors") + " --summary=" + Path("a.json"))
                .status,
            0);
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights().size(), 53u);
}

TEST_F(Cli, InterruptKeepsTheBestNetworkSoFar) {
  const Result result =
      Run("fit --material=builtin:satin-gold --max_iterations=100000 "
          "--function_tolerance=0 --out=" +
          Path("a.safetensors") + " --summary=" + Path("a.json") +
          " & pid=$!; sleep 3; kill -INT $pid; wait $pid");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights().size(), 675u);
  EXPECT_EQ(json::parse(ReadFile(Path("a.json"), 1 << 20))["termination"], "interrupted");
}

// The same samples, and the same sums.
TEST_F(Cli, FitAndMeasureReportTheSameNumbers) {
  const std::string material = " --material=builtin:satin-gold";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors") +
                " --summary=" + Path("a.json"))
                .status,
            0);
  const json fit = json::parse(ReadFile(Path("a.json"), 1 << 20));
  const Result measured = Run("measure --json --fit=" + Path("a.safetensors") + material);
  ASSERT_EQ(measured.status, 0) << measured.err;
  const json measures = json::parse(measured.out);
  EXPECT_EQ(measures["mean_abs_log_error"], fit["mean_abs_log_error"]);
  for (const auto& [key, value] : measures.items()) EXPECT_EQ(value, fit[key]) << key;
}

TEST_F(Cli, MeasureHasExactlyTheDocumentedKeys) {
  const std::string material = " --material=builtin:satin-gold";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const Result measured =
      Run("measure --json --samples=2000 --fit=" + Path("a.safetensors") + material);
  ASSERT_EQ(measured.status, 0) << measured.err;
  const json measures = json::parse(measured.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : measures.items()) {
    keys.push_back(key);
    if (key == "measured_in_plane" || key == "cut_short") {
      EXPECT_TRUE(value.is_boolean());
    } else if (key == "cautions") {
      EXPECT_EQ(value, json::array());
    } else {
      EXPECT_EQ(value.is_number(), !key.ends_with("energy")) << key;
    }
  }
  EXPECT_THAT(keys,
              testing::UnorderedElementsAre(
                  "mean_abs_log_error", "error_at_measured", "reciprocal_floor", "measured_part",
                  "measured_in_plane", "measured_negative", "measured_noise", "cut_short", "rmse",
                  "hrl", "hcl", "max_directional_albedo", "energy", "eal",
                  "material_max_directional_albedo", "material_energy", "chromaticity_error",
                  "delta_e_mean", "delta_e_p95", "dark_hue_chroma_mean", "dark_hue_chroma_p95",
                  "parameters", "samples", "dark_samples", "relative_error", "cautions"));
  EXPECT_EQ(measures["parameters"], 7 * 5 + 6 * 3);
  EXPECT_EQ(measures["samples"], 2000);
  const Result text = Run("measure --samples=2000 --fit=" + Path("a.safetensors") + material);
  EXPECT_THAT(text.out, HasSubstr("Helmholtz reciprocity loss (eq. 8)"));
  for (const std::string& key : keys) {
    if (key == "cautions") continue;
    EXPECT_THAT(text.out, HasSubstr(key + " "));
  }
}

TEST_F(Cli, AFitThatExplainsNothingSaysSo) {
  const std::string scaled = " --material=builtin:satin-gold --scale_to_albedo=";
  const std::string fit = " --samples=1000 --max_iterations=3 --out=" + Path("a.safetensors");
  const Result wrong_unit = Run("fit" + scaled + "1e-6" + fit);
  ASSERT_EQ(wrong_unit.status, 0) << wrong_unit.err;
  EXPECT_THAT(wrong_unit.out, HasSubstr("1/sr, where a white diffuse surface has 0.32"));
  EXPECT_THAT(wrong_unit.out, HasSubstr("the fit explains nothing: values are wrong by "));
  EXPECT_THAT(Run("info ggx:f0=0,alpha=0.2").out, testing::Not(HasSubstr("another one")));
  const Result another =
      Run("measure --json --fit=" + Path("a.safetensors") + " --material=builtin:spectralon");
  ASSERT_EQ(another.status, 0) << another.err;
  const json measures = json::parse(another.out);
  EXPECT_NEAR(measures["relative_error"], 1.0, 0.01);
  EXPECT_EQ(measures["cautions"],
            json::array({"the fit explains nothing: values are wrong by 100 % in the mean"}));
}

TEST_F(Cli, MeasureProvesTheEnergyOfNetworks) {
  const std::string material = " --material=builtin:satin-gold";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const std::string measure =
      "measure --prove --prove_seconds=2 --samples=2000 --fit=" + Path("a.safetensors") + material;
  const json proof = json::parse(Run(measure + " --json").out)["energy_proof"];
  EXPECT_GE(proof["max_directional_albedo"],
            json::parse(Run(measure + " --json").out)["max_directional_albedo"]);
  EXPECT_EQ(proof["is_proved"], proof["proved_part"] > 0.999999);
  const std::string text = Run(measure).out;
  EXPECT_THAT(text, HasSubstr("  energy: no directional albedo is above "));
  EXPECT_THAT(text, HasSubstr("  reciprocity: by construction"));
  EXPECT_THAT(Run("measure --prove --fit=ggx:f0=0,alpha=0.2" + material).err,
              HasSubstr("--prove needs a network"));
}

TEST_F(Cli, MeasureSaysWhereEnergyIsMade) {
  const std::string material = " --material=builtin:spectralon --scale_to_albedo=1.5 ";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const std::string measure = "measure --json --samples=2000 --fit=" + Path("a.safetensors");
  const json measures = json::parse(Run(measure + material).out);
  EXPECT_THAT(std::string(measures["energy"]), testing::StartsWith("albedo 1 + 0."));
  EXPECT_THAT(std::string(measures["material_energy"]), testing::StartsWith("albedo 1 + 0.5 at "));
  ASSERT_EQ(
      Run("fit" + material + kQuick + "--terms=log,energy --out=" + Path("b.safetensors")).status,
      0);
  const std::string measure_b = "measure --json --samples=2000 --fit=" + Path("b.safetensors");
  EXPECT_EQ(json::parse(Run(measure_b + material).out)["energy"], "certified");
}

TEST_F(Cli, AFitThatTheClockEndsIsCertifiedAndSaysSo) {
  const Result result =
      Run("fit --material=builtin:spectralon --max_seconds=0.3 --max_iterations=100000" +
          std::string(" --function_tolerance=0 --out=") + Path("a.safetensors") +
          " --summary=" + Path("a.json"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("--max_seconds ended the fit before it was done"));
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(summary["termination"], "max_seconds");
  EXPECT_EQ(summary["energy"], "certified");
  EXPECT_EQ(summary["cut_short"], true);
  EXPECT_THAT(summary["problem"], HasSubstr("--max_seconds=0.3"));  // as asked for
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).weights().size(), 675u);
}

}  // namespace
}  // namespace pbnbrdf
