// Every command, its output, its errors and exit statuses.
#include <map>
#include <sstream>

#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr const char* kCommands[] = {"fit",     "measure",   "info", "eval", "export",
#ifdef PBNBRDF_HAS_RENDER
                                     "render",  "fit-scene",
#endif
                                     "compare", "fit-model"};

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The first lines of those that explain a flag, "  --name    help".
std::vector<std::string> FlagLines(const std::string& help) {
  std::vector<std::string> lines = Lines(help);
  std::erase_if(lines, [](const std::string& line) {
    return !line.starts_with("  --") || line.find("  ", 2) == line.npos;
  });
  return lines;
}

std::string NameOfFlag(const std::string& line) { return line.substr(2, line.find(' ', 2) - 2); }

TEST_F(Cli, HelpTeaches) {
  const Result overview = Run("--help");
  EXPECT_EQ(overview.status, 0);
  std::size_t at = 0;
  for (const char* command : kCommands) {
    const std::size_t next = overview.out.find(StrCat("\n  ", command, " "));
    ASSERT_NE(next, overview.out.npos) << command;
    EXPECT_LT(at, next) << command;  // in the order that people need
    at = next;
    const Result help = Run(StrCat(command, " --help"));
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr(StrCat("  pbnbrdf ", command, " ")));
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done, 1 bad input or output, 2 wrong usage."));
  }
  EXPECT_THAT(Run("--version").out, StartsWith("pbnbrdf 0."));
}

TEST_F(Cli, HelpShowsADozenFlagsAndWhereTheRestAre) {
  for (const char* command : kCommands) {
    const std::string help = Run(StrCat(command, " --help")).out;
    const std::string all = Run(StrCat(command, " --help=all")).out;
    const std::vector<std::string> shown = FlagLines(help), flags = FlagLines(all);
    EXPECT_LE(shown.size(), 14u) << command;
    EXPECT_EQ(shown.size() < flags.size(), help.find("--help=all shows all flags") != help.npos)
        << command;
    EXPECT_THAT(all, Not(HasSubstr("--help=all"))) << command;
    for (const std::string& line : shown) {
      EXPECT_THAT(all, HasSubstr("\n  " + NameOfFlag(line) + " ")) << command;
    }
    for (const std::string& text : {help, all}) {
      for (const std::string& line : Lines(text)) EXPECT_LE(line.size(), 100u) << line;
    }
  }
  EXPECT_GE(FlagLines(Run("fit --help").out).size(), 10u);
  EXPECT_GE(FlagLines(Run("fit --help=all").out).size(), 30u);
}

TEST_F(Cli, EveryFlagHasAHelpLine) {
  for (const char* command : kCommands) {
    for (const std::string& line : FlagLines(Run(StrCat(command, " --help=all")).out)) {
      const std::string help(Trim(line.substr(2 + NameOfFlag(line).size())));
      EXPECT_GT(help.size(), 5u) << command << " " << line;
      EXPECT_FALSE(help.starts_with("[")) << command << " " << line;
    }
  }
}

TEST_F(Cli, HelpNamesEveryChoice) {
  std::string help;  // as one line
  for (const std::string& line : Lines(Run("fit --help=all").out)) help.append(Trim(line)) += " ";
  for (const char* choice : {"cartesian", "reciprocal", "multiscale", "merl", "anisotropic",
                             "tanh | relu", "l2 | soft_l1 | absolute", "uniform | highlight",
                             "single | double", "lm", "ceres_lm", "ceres_lbfgs", "adam", "autodiff",
                             "log (eq. 6)", "chromaticity (eq. 7)", "energy (eq. 5)"}) {
    EXPECT_THAT(help, HasSubstr(choice));
  }
}

TEST_F(Cli, OldNamesTellTheNewOnes) {
  ExpectError("tabulate --material=x --out=y", 2, "tabulate is now export --format=merl");
  ExpectError("values --material=x", 2, "values is now eval");
  ExpectError("eval --fit=x --material=y", 2, "eval --fit is now measure --fit");
  ExpectError("measure --fit=x --eval_samples=5", 2, "--eval_samples is now --samples");
  const std::string fit = "fit --material=builtin:satin-gold --out=" + Path("out");
  ExpectError(fit + " --model=ggx", 2, "fit --model is now fit-model");
  ExpectError("fit --scene=x --out_dir=y", 2, "fit --scene is now fit-scene");
  ExpectError(fit + " --solver=tiny_lm", 2, "--solver=tiny_lm is now --solver=lm");
  ExpectError(fit + " --solver tiny_lm", 2, "--solver=tiny_lm is now --solver=lm");
  ExpectError(fit + " --solver=lbfgs", 2, "--solver=lbfgs is now --solver=ceres_lbfgs");
  ExpectError(fit + " --log_weight=2", 2, "--log_weight=W is now --terms=log:W");
  ExpectError(fit + " --chromaticity_weight=2", 2, "is now --terms=log,chromaticity:W");
  ExpectError(fit + " --energy_weight=2", 2, "is now --terms=log,energy:W");
  ExpectError(fit + " --jacobian=autodiff", 2, "--jacobian=autodiff is now --solver=autodiff");
  WriteBytes(Path("old.flags"), "--jacobian=condensed\n");
  ExpectError(fit + " --flagfile=" + Path("old.flags"), 2, "old.flags: --jacobian=condensed is");
}

TEST_F(Cli, WrongUsageExitsWith2) {
  ExpectError("", 2, "no command given: fit | measure");
  ExpectError(
      "fitt", 2,
      "'fitt' is not a command: fit | measure | info | eval | export | render | fit-scene | "
      "compare | fit-model; see pbnbrdf --help");
  ExpectError("fit", 2, "--material is required");
  ExpectError("fit --material=builtin:satin-gold", 2, "--out is required");
  ExpectError("info builtin: --all", 2, "--all is not a flag");
  const std::string fit = "fit --material=builtin:satin-gold --out=" + Path("out");
  ExpectError(fit + " --sample=3", 2, "--sample is not a flag; did you mean --samples?");
  ExpectError(fit + " --json", 2, "--json is not a flag");
  ExpectError(fit + " --samples=many", 2, "--samples: 'many' is not a whole number");
  ExpectError(fit + " --samples=0", 2, "--samples = 0; must be 1 to");
  ExpectError(fit + " --samples", 2, "--samples needs a value");
  ExpectError(fit + " --loss=hubr", 2, "--loss=hubr is not one of l2 | soft_l1 | absolute");
  ExpectError(fit + " --terms=log,colour", 2, "--terms=colour is not one of log | chromaticity");
  ExpectError(fit + " --terms=energy", 2, "--terms: log or chromaticity must be among them");
  ExpectError(fit + " --encoding=polar", 2, "--encoding=polar is not one of auto | cartesian");
  ExpectError(fit + " --activation=gelu", 2, "--activation=gelu is not one of tanh | relu");
  ExpectError(fit + " --hidden=21,x", 2, "--hidden: 'x' is not a whole number");
  ExpectError(fit + " --hidden=21,-3", 2, "--hidden = -3; must be 1 to 256");
  ExpectError(fit + " --hidden=5000", 2, "--hidden = 5000; must be 1 to 256");
  ExpectError(fit + " --loss_scale=0", 2, "--loss_scale = 0; must be finite and > 0");
  ExpectError(fit + " --max_seconds=-1", 2, "--max_seconds = -1; must be finite and > 0");
  ExpectError(fit + " --loss=absolute", 2, "--loss: absolute isn't a sum of squares");
  ExpectError(fit + " --solver=adam --energy_angles=0", 2,
              "--energy_angles = 0; must be 1 to 1024");
  ExpectError(fit + " --starts=0", 2, "--starts = 0; must be >= 1");
  ExpectError(fit + " --threads=-1", 2, "--threads = -1; must be >= 0");
  ExpectError(fit + " --scale_to_albedo=-0.5", 2,
              "--scale_to_albedo = -0.5; must be finite and >= 0");
  for (const char* scale : {"nan", "inf"}) {
    ExpectError(fit + " --scale_to_albedo=" + scale, 2,
                StrCat("--scale_to_albedo: '", scale, "' is not a finite number"));
  }
  ExpectError(fit + " --terms=log,chromaticity:0", 2,
              "--terms: the weight of chromaticity = 0; must be finite and > 0");
  ExpectError(fit + " --terms=log,log:2", 2, "--terms: log is there twice");
  ExpectError(fit + " --solver=newton", 2, "--solver=newton is not one of lm | ceres_lm");
  ExpectError(fit + " gold.binary", 2, "'gold.binary' is not a flag");
  ExpectError("info", 2, "a file or another source is missing");
}

TEST_F(Cli, UnwritableOutputsAreFoundBeforeTheWork) {
  ExpectError("fit --material=builtin:satin-gold --out=" + Path("none/x"), 1,
              "x: cannot write: no folder");
  ExpectError(
      "fit --material=builtin:satin-gold --out=" + Path("out") + " --summary=" + Path("none/s"), 1,
      "s: cannot write");
  ExpectError("export --format=merl --material=builtin:satin-gold --out=" + Path(""), 1,
              "is a folder");
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

TEST_F(Cli, AnAnisotropicMaterialIsTabulatedByItsIsotropicFit) {
  const std::string brass = " --material=builtin:rolled-brass";
  ExpectError("export --format=merl" + brass + " --out=" + Path("out"), 1,
              "builtin:rolled-brass: anisotropic, and a MERL table has no phi_h");
  ASSERT_EQ(Run("fit" + brass + kQuick + "--encoding=merl --out=" + Path("a.safetensors")).status,
            0);
  EXPECT_EQ(
      Run("export --format=merl --material=" + Path("a.safetensors") + " --out=" + Path("a.binary"))
          .status,
      0);
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
  // The CSV names the directions that its values are at; they alone are evaluated again.
  const auto written = ReadCsvRows(Path("x.csv"));
  std::string pairs = "theta_i,phi_i,theta_o,phi_o\n";
  for (const auto& row : written) {
    pairs += row[0] + "," + row[1] + "," + row[2] + "," + row[3] + "\n";
  }
  WriteBytes(Path("pairs.csv"), pairs);
  const std::string eval = "eval --material=" + network + " --directions=";
  ASSERT_EQ(Run(eval + Path("pairs.csv") + " --out=" + Path("values.csv")).status, 0);
  const auto computed = ReadCsvRows(Path("values.csv"));
  ASSERT_EQ(computed.size(), written.size());
  for (std::size_t c = 4; c < 7; ++c) {
    EXPECT_EQ(ParseNumber("written", written[1000][c]), ParseNumber("computed", computed[1000][c]));
  }
  ExpectError(eval + Path("x.csv") + " --out=" + Path("out"), 1, "there is a column r already");
  EXPECT_THAT(Run("export --fit=" + network + " --format=c --name=paint --out=-").out,
              HasSubstr("paint_eval("));
}

TEST_F(Cli, ExportsThatCannotBeAreNamed) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold" + kQuick + "--out=" + network).status, 0);
  const std::string to = "export --fit=" + network + " --out=" + Path("out");
  ExpectError(to, 2, "--format is required");
  ExpectError("export --format=c --out=" + Path("out"), 2, "--fit is required");
  ExpectError("export --format=merl --out=" + Path("out"), 2, "--fit or --material is required");
  ExpectError(to + " --format=merl --material=builtin:satin-gold", 2,
              "--fit and --material: give one of them only");
  ExpectError("export --format=c --material=builtin:satin-gold --out=" + Path("out"), 2,
              "--format=c exports networks only: give one with --fit");
  ExpectError("export --fit=x --format=c", 2, "--out is required");
  ExpectError(to + " --format=obj", 2,
              "--format=obj is not one of npy | h5 | merl | csv | c | glsl");
  ExpectError(to + " --format=c --name=a-b", 1, "a.safetensors, exported as c: name=a-b is not");
  ExpectError("export --format=npy --fit=" + network + " --out=" + Path("x_fc1.npy"), 1,
              "a.safetensors, exported as npy: an NBRDF network has relu units and the cartesian "
              "encoding, this one is tanh, merl");
  ExpectError("export --format=c --fit=" + Path("none.safetensors") + " --out=" + Path("out"), 1,
              "none.safetensors: no such file");
  ExpectError("export --format=mitsuba --fit=" + network + " --out=" + Path("none/x.py"), 1,
              "x.py: cannot write: no folder");
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

// The same file, by a name for any source and by one for networks.
TEST_F(Cli, ExportMakesATableOfAnySource) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold" + kQuick + "--out=" + network).status, 0);
  for (const auto& [flag, file] :
       {std::pair("--fit=", "a.binary"), std::pair("--material=", "b.binary")}) {
    const Result result = Run("export --format=merl " + (flag + network) + " --out=" + Path(file));
    ASSERT_EQ(result.status, 0) << result.err;
  }
  EXPECT_EQ(ReadFile(Path("a.binary"), 1 << 26), ReadFile(Path("b.binary"), 1 << 26));
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
    if (key == "measured_in_plane") {
      EXPECT_TRUE(value.is_boolean());
    } else {
      EXPECT_EQ(value.is_number(), !key.ends_with("energy")) << key;
    }
  }
  EXPECT_THAT(keys,
              testing::UnorderedElementsAre(
                  "mean_abs_log_error", "error_at_measured", "reciprocal_floor", "measured_part",
                  "measured_in_plane", "rmse", "hrl", "hcl", "max_directional_albedo", "energy",
                  "eal", "material_max_directional_albedo", "material_energy", "chromaticity_error",
                  "delta_e_mean", "delta_e_p95", "dark_hue_chroma_mean", "dark_hue_chroma_p95",
                  "parameters", "samples", "dark_samples"));
  EXPECT_EQ(measures["parameters"], 7 * 5 + 6 * 3);
  EXPECT_EQ(measures["samples"], 2000);
  const Result text = Run("measure --samples=2000 --fit=" + Path("a.safetensors") + material);
  EXPECT_THAT(text.out, HasSubstr("Helmholtz reciprocity loss (eq. 8)"));
  for (const std::string& key : keys) EXPECT_THAT(text.out, HasSubstr(key + " "));
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

TEST_F(Cli, EvalAppendsToWhatItReads) {
  WriteBytes(Path("pairs.csv"), "name,theta_i,phi_i,theta_o,phi_o\na,0.3,0,0.5,1\nb,0.3,0,2,1\n");
  ASSERT_EQ(Run("eval --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                " --out=" + Path("values.csv"))
                .status,
            0);
  const std::string f = FormatFullPrecision(0.99 / kPi);
  EXPECT_EQ(ReadFile(Path("values.csv"), 1 << 20),
            StrCat("name,theta_i,phi_i,theta_o,phi_o,r,g,b\na,0.3,0,0.5,1,", f, ",", f, ",", f,
                   "\nb,0.3,0,2,1,0,0,0\n"));
}

TEST_F(Cli, EvalTakesVectorsFromStandardInput) {
  const Result result =
      Run("eval --material=builtin:spectralon --directions=- --out=- <<'END'\n"
          "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,2,1,0,1\nEND\n");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.out, HasSubstr("0,0,2,1,0,1," + FormatFullPrecision(0.99 / kPi)));
}

TEST_F(Cli, EvalTakesTheDialectsOfText) {
  const std::string f = FormatFullPrecision(0.99 / kPi);
  const auto values = [&](const std::string& csv) {
    WriteBytes(Path("pairs.csv"), csv);
    return Run("eval --material=builtin:spectralon --out=- --directions=" + Path("pairs.csv"));
  };
  EXPECT_EQ(values("\xef\xbb\xbfTheta_I;phi_i;theta_o;phi_o\r\n# why\r\n0.3;0;-0.5;1").out,
            StrCat("Theta_I;phi_i;theta_o;phi_o;r;g;b\n0.3;0;-0.5;1;", f, ";", f, ";", f, "\n"));
  EXPECT_EQ(values("# theta_i phi_i theta_o phi_o\n0 0 0.5 1\n").out,
            StrCat("# theta_i phi_i theta_o phi_o r g b\n0 0 0.5 1 ", f, " ", f, " ", f, "\n"));
  const Result tabs =
      values("theta_i\tphi_i\ttheta_o\tphi_o\tnote\n0\t0\t0\t0\t\n0\tnan\t0\t0\tx\n");
  EXPECT_EQ(tabs.out, StrCat("theta_i\tphi_i\ttheta_o\tphi_o\tnote\tr\tg\tb\n0\t0\t0\t0\t\t", f,
                             "\t", f, "\t", f, "\n"));
  EXPECT_EQ(tabs.err, "pbnbrdf: 1 rows that lack a direction are left out\n");
}

TEST_F(Cli, EvalReadsDirectionsOfOtherPrograms) {
  PBNBRDF_REFERENCE_FILE(folder, "faults/directions_csv");
  const auto rows = [&](const std::string& csv) {
    const Result result =
        Run("eval --material=builtin:satin-gold --out=- --directions='" + csv + "'");
    EXPECT_EQ(result.status, 0) << result.err;
    std::vector<std::string> values;
    for (const std::string& row : Split(result.out, '\n')) {
      const std::vector<std::string> cells = Split(row, ',');
      if (cells.size() == 7) values.push_back(cells[4]);
    }
    return values;
  };
  WriteBytes(Path("radians.csv"),
             StrCat("theta_i,phi_i,theta_o,phi_o\n", kPi / 4, ",0,", kPi / 6, ",", kPi, "\n",
                    kPi / 3, ",0,", kPi / 4, ",", kPi / 2, "\n"));
  const auto radians = rows(Path("radians.csv")), degrees = rows(folder + "/deg_columns.csv");
  ASSERT_EQ(degrees.size(), 3u);
  for (int k : {1, 2}) {
    EXPECT_NEAR(ParseNumber("r", degrees[k]), ParseNumber("r", radians[k]), 1e-4) << k;
  }
  EXPECT_EQ(rows(folder + "/q_bom.csv").size(), 2u);
  const auto signed_theta = rows(folder + "/q_negtheta.csv");
  EXPECT_NEAR(ParseNumber("r", signed_theta[1]), ParseNumber("r", signed_theta[2]), 1e-9);
  ExpectError("eval --material=builtin:satin-gold --out=- --directions='" + folder +
                  "/deg_in_rad_columns.csv'",
              1, "theta_i is 45 radians");
}

TEST_F(Cli, BadDirectionsAreNamed) {
  const auto values = [&](const std::string& csv, const std::string& message) {
    WriteBytes(Path("pairs.csv"), csv);
    ExpectError("eval --material=builtin:spectralon --directions=" + Path("pairs.csv") +
                    " --out=" + Path("out"),
                1, message);
  };
  values("", "pairs.csv: the first line must name the columns theta_i,phi_i,theta_o,phi_o");
  values("theta_i,phi_i,theta_o\n", "the first line must name the columns");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3\n", "line 2: 3 columns, expected 4");
  values("theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n\n1,2,x,4\n",
         "line 4, theta_o: 'x' is not a finite");
  values("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,0,0,0,1\n", "line 2: a direction has no length");
  values("theta_i,phi_i,theta_o,phi_o\n45,0,30,180\n",
         "line 2: theta_i is 45 radians; must be -3.14159 to 3.14159 (theta_i is in radians, "
         "theta_i_deg");
  values("theta_i,phi_i,theta_o,phi_o,R,g,b\n0,0,0,0,1,1,1\n",
         "line 1: there is a column r already; r,g,b are what is appended");
  values("theta_i,phi_i,theta_o,phi_o,phi_o\n", "two columns have the name phi_o");
  values("theta_i_deg,phi_i,theta_o,phi_o\n", "phi_i in radians and theta_i_deg in degrees");
  values("theta_i;phi_i;theta_o;phi_o\n0,1;0;0;0\n", "theta_i: '0,1' has a decimal comma");
  values(std::string("\xff\xfet\0", 4), "pairs.csv: UTF-16 text");
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
              "x.flags: --los is not a flag; did you mean --loss?");
  WriteBytes(Path("y.flags"), "--flagfile=" + Path("x.flags") + "\n");
  ExpectError("fit --flagfile=" + Path("y.flags"), 2, "y.flags: " + Path("x.flags") + ": --los");
  WriteBytes(Path("z.flags"), "--flagfile=" + Path("z.flags") + "\n");
  ExpectError("fit --flagfile=" + Path("z.flags"), 2, "flagfiles are nested too deep");
  WriteBytes(Path("w.flags"), "loss=l2\n");
  ExpectError("fit --flagfile=" + Path("w.flags"), 2, "w.flags: 'loss=l2' is not a flag");
  ExpectError("fit --flagfile=" + Path("none.flags") + " --out=" + Path("out"), 1, "no such file");
}

TEST_F(Cli, OddOutputsAreHandled) {
  const std::string fit = "fit --material=builtin:satin-gold" + kQuick;
  ExpectError(fit + "--out=" + Path("out") + " --summary=" + Path("out"), 2,
              "--out and --summary name the same file");
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

}  // namespace
}  // namespace pbnbrdf
