// Every command, its output, its errors and exit statuses.
#include <map>

#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

TEST_F(Cli, HelpTeaches) {
  const Result overview = Run("--help");
  EXPECT_EQ(overview.status, 0);
  for (const char* command :
       {"fit", "eval", "export", "tabulate", "values", "info", "compare", "render"}) {
    EXPECT_THAT(overview.out, HasSubstr(StrCat("  ", command, " ")));
    const Result help = Run(StrCat(command, " --help"));
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr(StrCat("  pbnbrdf ", command, " ")));
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done, 1 bad input or output, 2 wrong usage."));
  }
  EXPECT_THAT(Run("--version").out, StartsWith("pbnbrdf 0."));
}

TEST_F(Cli, HelpNamesEveryChoice) {
  const std::string help = Run("fit --help").out;
  for (const char* choices :
       {"cartesian | reciprocal | multiscale | merl | bilateral | anisotropic", "tanh | relu",
        "l2 | soft_l1 | huber | cauchy", "uniform", "highlight", "single | double",
        "condensed | autodiff"}) {
    EXPECT_THAT(help, HasSubstr(choices));
  }
}

TEST_F(Cli, WrongUsageExitsWith2) {
  ExpectError("", 2, "no command given: fit | eval");
  ExpectError("fitt", 2, "'fitt' is not a command: fit | eval | export | tabulate | values | info | compare");
  ExpectError("fit", 2, "--material is required");
  ExpectError("fit --material=builtin:satin-gold", 2, "--out is required");
  const std::string fit = "fit --material=builtin:satin-gold --out=" + Path("out");
  ExpectError(fit + " --sample=3", 2, "--sample is not a flag of 'fit'; did you mean --samples?");
  ExpectError(fit + " --json", 2, "--json is not a flag of 'fit'");
  ExpectError(fit + " --samples=many", 2, "--samples=many is not a uint64 value");
  ExpectError(fit + " --samples=0", 2, "--samples = 0; must be 1 to");
  ExpectError(fit + " --samples", 2, "--samples needs a value");
  ExpectError(fit + " --loss=hubr", 2, "--loss=hubr is not one of l2 | soft_l1 | huber | cauchy");
  ExpectError(fit + " --terms=log,colour", 2, "--terms=colour is not one of log | chromaticity");
  ExpectError(fit + " --terms=energy", 2, "--terms: log or chromaticity must be among them");
  ExpectError(fit + " --encoding=polar", 2, "--encoding=polar is not one of auto | cartesian");
  ExpectError(fit + " --activation=gelu", 2, "--activation=gelu is not one of tanh | relu");
  ExpectError(fit + " --hidden=21,x", 2, "--hidden: 'x' is not a whole number");
  ExpectError(fit + " --hidden=21,-3", 2, "--hidden: a layer of -1 units");
  ExpectError(fit + " --hidden=5000", 2, "--hidden: a layer of 5000 units; must be 1 to 256");
  ExpectError(fit + " --loss_scale=0", 2, "--loss_scale = 0; must be finite and > 0");
  ExpectError(fit + " --max_seconds=-1", 2, "--max_seconds = -1; must be > 0");
  ExpectError(fit + " --loss=absolute", 2, "--loss: absolute isn't a sum of squares");
  ExpectError(fit + " --solver=adam --energy_angles=0", 2,
              "--energy_angles = 0; must be 1 to 1024");
  ExpectError(fit + " --starts=0", 2, "--starts = 0; must be >= 1");
  ExpectError(fit + " --threads=-1", 2, "--threads = -1; must be >= 0");
  for (const char* scale : {"-0.5", "nan", "inf"}) {
    ExpectError(fit + " --scale_to_albedo=" + scale, 2, "--scale_to_albedo = ");
  }
  ExpectError(fit + " gold.binary", 2, "'gold.binary' is not a flag");
  ExpectError("info", 2, "a file or another source is missing");
}

TEST_F(Cli, UnwritableOutputsAreFoundBeforeTheWork) {
  ExpectError("fit --material=builtin:satin-gold --out=" + Path("none/x"), 1,
              "x: cannot write: no folder");
  ExpectError(
      "fit --material=builtin:satin-gold --out=" + Path("out") + " --summary=" + Path("none/s"), 1,
      "s: cannot write");
  ExpectError("tabulate --material=builtin:satin-gold --out=" + Path(""), 1, "is a folder");
}

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
  EXPECT_THAT(automatic.out, Not(HasSubstr("best isotropic one")));
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
  EXPECT_THAT(isotropic.out, HasSubstr("the material is anisotropic, the fit the best isotropic "
                                       "one: --encoding=anisotropic goes further\n"));
  ExpectError("fit --material=builtin:satin-gold --encoding=anisotropic --out=" + Path("out"), 1,
              "builtin:satin-gold: encoding: anisotropic is for anisotropic materials");
}

TEST_F(Cli, AnAnisotropicMaterialIsTabulatedByItsIsotropicFit) {
  const std::string brass = " --material=builtin:rolled-brass";
  ExpectError("tabulate" + brass + " --out=" + Path("out"), 1,
              "builtin:rolled-brass: anisotropic, and a MERL table has no phi_h");
  ASSERT_EQ(Run("fit" + brass + kQuick + "--encoding=merl --out=" + Path("a.safetensors")).status,
            0);
  EXPECT_EQ(
      Run("tabulate --material=" + Path("a.safetensors") + " --out=" + Path("a.binary")).status, 0);
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
  const Result fit = Run("fit --material=builtin:satin-gold --jacobian=autodiff --terms=log" +
                         kQuick + "--samples=50 --out=" + Path("a.safetensors"));
  EXPECT_EQ(fit.status, 0) << fit.err;
}

TEST_F(Cli, ExportWritesEveryFormat) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold --encoding=cartesian --activation=relu" +
                kQuick + "--hidden=5,4 --out=" + network)
                .status,
            0);
  const std::map<std::string, std::string> files = {
      {"npy", "x_fc1.npy"}, {"h5", "x.h5"},     {"merl", "x.binary"}, {"csv", "x.csv"},
      {"c", "x.h"},         {"glsl", "x.glsl"}, {"mitsuba", "x.py"},  {"onnx", "x.onnx"}};
  const std::string help = Run("export --help").out;
  for (const auto& [format, file] : files) {
    EXPECT_THAT(help, HasSubstr("  " + format + " "));
    const Result result =
        Run("export --fit=" + network + " --format=" + format + " --out=" + Path(file));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(Path(file))) << format;
  }
  EXPECT_THAT(help, HasSubstr("npy | h5 | merl | csv | c | glsl | mitsuba | onnx"));
  EXPECT_EQ(NeuralBrdf::Read(Path("x_weights.safetensors")).weights(),
            NeuralBrdf::Read(network).weights());
  // The CSV names the directions that its values are at.
  const Result values =
      Run("values --material=" + network + " --directions=" + Path("x.csv") + " --out=-");
  const std::vector<std::string> row = Split(Split(values.out, '\n')[1000], ',');
  ASSERT_EQ(row.size(), 10u);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(ParseNumber("written", row[4 + c]), ParseNumber("computed", row[7 + c]));
  }
  EXPECT_THAT(Run("export --fit=" + network + " --format=c --name=paint --out=-").out,
              HasSubstr("paint_eval("));
}

TEST_F(Cli, ExportsThatCannotBeAreNamed) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold" + kQuick + "--out=" + network).status, 0);
  const std::string to = "export --fit=" + network + " --out=" + Path("out");
  ExpectError(to, 2, "--format is required");
  ExpectError("export --format=c --out=" + Path("out"), 2, "--fit is required");
  ExpectError("export --fit=x --format=c", 2, "--out is required");
  ExpectError(to + " --format=obj", 2,
              "--format=obj is not one of npy | h5 | merl | csv | c | glsl");
  ExpectError(to + " --format=c --name=a-b", 1, "a.safetensors, exported as c: name=a-b is not");
  ExpectError(
      "export --format=npy --fit=" + network + " --out=" + Path("x_fc1.npy"), 1,
      "a.safetensors, exported as npy: an NBRDF network has relu units behind the cartesian "
      "encoding, this one is tanh, merl");
  ExpectError("export --format=c --fit=" + Path("none.safetensors") + " --out=" + Path("out"), 1,
              "none.safetensors: no such file");
  ExpectError("export --format=mitsuba --fit=" + network + " --out=" + Path("none/x.py"), 1,
              "x.py: cannot write: no folder");
}

TEST_F(Cli, EvalHasExactlyTheDocumentedKeys) {
  const std::string material = " --material=builtin:satin-gold";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const Result eval =
      Run("eval --json --eval_samples=2000 --fit=" + Path("a.safetensors") + material);
  ASSERT_EQ(eval.status, 0) << eval.err;
  const json measures = json::parse(eval.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : measures.items()) {
    keys.push_back(key);
    EXPECT_EQ(value.is_number(), !key.ends_with("energy")) << key;
  }
  EXPECT_THAT(keys, testing::UnorderedElementsAre(
                        "mean_abs_log_error", "rmse", "hrl", "hcl", "max_directional_albedo",
                        "energy", "eal", "material_max_directional_albedo", "material_energy",
                        "chromaticity_error", "delta_e_mean", "delta_e_p95", "dark_hue_chroma_mean",
                        "dark_hue_chroma_p95", "parameters", "samples", "dark_samples"));
  EXPECT_EQ(measures["parameters"], 7 * 5 + 6 * 3);
  EXPECT_EQ(measures["samples"], 2000);
  const Result text = Run("eval --eval_samples=2000 --fit=" + Path("a.safetensors") + material);
  EXPECT_THAT(text.out, HasSubstr("Helmholtz reciprocity loss (eq. 8)"));
  for (const std::string& key : keys) EXPECT_THAT(text.out, HasSubstr(key + " "));
}

TEST_F(Cli, EvalSaysWhereEnergyIsMade) {
  const std::string material = " --material=builtin:spectralon --scale_to_albedo=1.5 ";
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const std::string eval = "eval --json --eval_samples=2000 --fit=" + Path("a.safetensors");
  const json measures = json::parse(Run(eval + material).out);
  EXPECT_THAT(std::string(measures["energy"]), testing::StartsWith("albedo 1 + 0."));
  EXPECT_THAT(std::string(measures["material_energy"]), testing::StartsWith("albedo 1 + 0.5 at "));
  ASSERT_EQ(
      Run("fit" + material + kQuick + "--terms=log,energy --out=" + Path("b.safetensors")).status,
      0);
  const std::string eval_b = "eval --json --eval_samples=2000 --fit=" + Path("b.safetensors");
  EXPECT_EQ(json::parse(Run(eval_b + material).out)["energy"], "certified");
}

TEST_F(Cli, ValuesAppendsToWhatItReads) {
  WriteBytes(Path("pairs.csv"), "name,theta_i,phi_i,theta_o,phi_o\na,0.3,0,0.5,1\nb,0.3,0,2,1\n");
  ASSERT_EQ(Run("values --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                " --out=" + Path("values.csv"))
                .status,
            0);
  const std::string f = FormatFullPrecision(0.99 / kPi);
  EXPECT_EQ(ReadFile(Path("values.csv"), 1 << 20),
            StrCat("name,theta_i,phi_i,theta_o,phi_o,r,g,b\na,0.3,0,0.5,1,", f, ",", f, ",", f,
                   "\nb,0.3,0,2,1,0,0,0\n"));
}

TEST_F(Cli, ValuesTakesVectorsFromStandardInput) {
  const Result result =
      Run("values --material=builtin:spectralon --directions=- --out=- <<'END'\n"
          "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,2,1,0,1\nEND\n");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("0,0,2,1,0,1," + FormatFullPrecision(0.99 / kPi)));
}

TEST_F(Cli, BadDirectionsAreNamed) {
  const auto values = [&](const std::string& csv, const std::string& message) {
    WriteBytes(Path("pairs.csv"), csv);
    ExpectError("values --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                    " --out=" + Path("out"),
                1, message);
  };
  values("", "pairs.csv: the first line must name the columns theta_i,phi_i,theta_o,phi_o");
  values("theta_i,phi_i,theta_o\n", "the first line must name the columns");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3\n", "line 2: 3 columns, expected 4");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n\n1,2,x,4\n",
         "line 4, theta_o: 'x' is not a finite");
  values("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0,0,0,1\n", "line 2: a direction has no length");
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

TEST_F(Cli, FlagfileErrorsNameTheFile) {
  WriteBytes(Path("x.flags"), "# a comment\n--loss=l2\n--los=l2\n");
  ExpectError("fit --flagfile=" + Path("x.flags") + " --out=" + Path("out"), 2,
              "x.flags: --los is not a flag of 'fit'; did you mean --loss?");
  ExpectError("fit --flagfile=" + Path("none.flags") + " --out=" + Path("out"), 1, "no such file");
}

TEST_F(Cli, OddOutputsAreHandled) {
  const std::string fit = "fit --material=builtin:satin-gold" + kQuick;
  ExpectError(fit + "--out=" + Path("out") + " --summary=" + Path("out"), 2, "two outputs at once");
  ExpectError(fit + "--out=" + Path(std::string(300, 'a')), 1, "cannot write: File name too long");
  ExpectError(fit + "--out=" + Path("out") + " --hidden=256,256", 2,
              "--hidden: makes 68355 weights");
  // A link stays a link.
  WriteBytes(Path("target"), "old");
  std::filesystem::create_symlink(Path("target"), Path("link"));
  ASSERT_EQ(Run(fit + "--out=" + Path("link")).status, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(Path("link")));
  EXPECT_EQ(NeuralBrdf::Read(Path("target")).weights().size(), 53u);
}

TEST_F(Cli, NamesThatAreNotUtf8AreHandled) {
  ASSERT_EQ(Run("tabulate --material=builtin:satin-gold --out=" + Path("\xff.binary")).status, 0);
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

}  // namespace
}  // namespace pbnbrdf
