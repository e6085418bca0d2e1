// The program as a user runs it: every command, its output, its errors and exit statuses.
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "brdf/rgl_writer.h"
#include "network/npy_writer.h"
#include "pbnbrdf/base/files.h"
#include "pbnbrdf/base/text.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Result {
  int status;
  std::string out, err;
};

class Cli : public testing::Test {
 protected:
  // Runs the shell's "pbnbrdf <arguments>".
  Result Run(const std::string& arguments) const {
    const std::string command = StrCat(PBNBRDF_PROGRAM, " ", arguments, " 2> ", folder_ / "stderr");
    FILE* pipe = popen(command.c_str(), "r");
    std::string out;
    std::array<char, 4096> buffer;
    while (std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
      out.append(buffer.data(), n);
    const int status = pclose(pipe);
    EXPECT_TRUE(WIFEXITED(status)) << "crashed: " << arguments;
    return {WEXITSTATUS(status), out, ReadFile(folder_ / "stderr", 1 << 20)};
  }

  // That it fails as promised: the status, one line on stderr, nothing left behind.
  void ExpectError(const std::string& arguments, int status, const std::string& message) const {
    const Result result = Run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    EXPECT_THAT(result.err, StartsWith("pbnbrdf: "));
    EXPECT_THAT(result.err, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << arguments;
  }

  std::string Path(const std::string& name) const { return folder_ / name; }

  // Flags of a fit that takes a moment.
  const std::string kQuick = " --samples=500 --max_iterations=4 --hidden=5 --terms=log ";

  TemporaryFolder folder_;
};

TEST_F(Cli, HelpTeaches) {
  const Result overview = Run("--help");
  EXPECT_EQ(overview.status, 0);
  for (const char* command : {"fit", "eval", "export", "tabulate", "values", "info"}) {
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
  ExpectError("fitt", 2, "'fitt' is not a command: fit | eval | export | tabulate | values | info");
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

TEST_F(Cli, BadMaterialsExitWith1) {
  const auto fit = [&](const std::string& material) {
    return "fit --material='" + material + "' --out=" + Path("out");
  };
  ExpectError(fit(Path("none.binary")), 1, "none.binary: no such file");
  ExpectError(fit("builtin:gold"), 1, "builtin:gold is not one of spectralon");
  ExpectError(fit("sgd:" + Path("none.csv") + "#x"), 1, "none.csv: no such file");
  WriteBytes(Path("short.binary"), std::string(100, '\0'));
  ExpectError(fit(Path("short.binary")), 1, "its header says 0 x 0 x 0, such as 90 x 90 x 180");
  WriteBytes(Path("bad.safetensors"), std::string(100, '\xff'));
  ExpectError(fit(Path("bad.safetensors")), 1, "bad.safetensors: not a safetensors file");
  ExpectError("tabulate --material=" + Path("none.binary") + " --out=" + Path("out"), 1,
              "no such file");
  ExpectError("eval --material=builtin:satin-gold --fit=" + Path("none.safetensors"), 1,
              "no such file");
  ExpectError("info " + Path("none.binary"), 1, "no such file");
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

TEST_F(Cli, AModelFitIsASourceAndAFit) {
  const std::string material = " --material=builtin:blue-plastic";
  const Result fit = Run("fit --model=ggx --samples=500 --starts=3 --seed=4" + material +
                         " --out=" + Path("a.json"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_EQ(fit.err, "");
  EXPECT_THAT(fit.out, HasSubstr("a.json: ggx:rho_d="));
  EXPECT_THAT(fit.out, HasSubstr("mean_abs_log_error"));
  const json file = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(file["model"], "ggx");
  EXPECT_EQ(file["seed"], 4);
  EXPECT_EQ(file["samples"], 500);
  EXPECT_EQ(file["material"], "builtin:blue-plastic");
  EXPECT_EQ(file["version"], Split(Split(Run("--version").out, '\n')[0], ' ')[1]);
  EXPECT_NEAR(file["parameters"]["alpha_x"], 0.05, 0.002);  // blue-plastic's
  EXPECT_LT(file["errors"]["mean_abs_log_error"], 0.01);

  const Result eval = Run("eval --json --eval_samples=2000 --fit=" + Path("a.json") + material);
  ASSERT_EQ(eval.status, 0) << eval.err;
  const json measures = json::parse(eval.out);
  EXPECT_EQ(measures["parameters"], 11);
  EXPECT_LT(measures["mean_abs_log_error"], 0.01);
  EXPECT_EQ(measures["hrl"], 0.0);

  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n");
  const std::string directions = " --out=- --directions=" + Path("pairs.csv");
  EXPECT_EQ(Run("values --material=" + Path("a.json") + directions).out,
            Run("values --material=" + std::string(file["source"]) + directions).out);
  EXPECT_EQ(Run("tabulate --material=" + Path("a.json") + " --out=" + Path("a.binary")).status, 0);
  const Result info = Run("info " + Path("a.json"));
  EXPECT_THAT(info.out, HasSubstr("Walter et al. 2007"));
  EXPECT_THAT(info.out, HasSubstr("  seed: 4\n"));
  ASSERT_EQ(Run("fit" + kQuick + "--material=" + Path("a.json") + " --out=" + Path("n.safetensors"))
                .status,
            0);
}

TEST_F(Cli, EveryModelFits) {
  const std::string listed = Run("info models:").out, help = Run("fit --help").out;
  for (const char* model : {"lambert", "oren_nayar", "phong", "blinn_phong", "lafortune", "ward",
                            "ward_duer", "ward_bounded", "cook_torrance", "ggx", "abc", "disney"}) {
    EXPECT_THAT(listed, HasSubstr(StrCat("\n", model, ": (")));
    EXPECT_THAT(help, HasSubstr(StrCat(" ", model)));
    const std::string out = Path(StrCat(model, ".json"));
    const Result fit = Run(StrCat("fit --quiet --samples=200 --starts=2 --max_iterations=5 ",
                                  "--lobes=2 --model=", model,
                                  " --material=builtin:red-satin-plastic --out=", out));
    EXPECT_EQ(fit.status, 0) << fit.err;
    EXPECT_EQ(fit.out + fit.err, "") << model;
    EXPECT_THAT(Run("info " + out).out, HasSubstr(StrCat(": ", model, ":")));
  }
}

TEST_F(Cli, ModelMistakesAreNamed) {
  const std::string fit = "fit --material=builtin:blue-plastic --out=" + Path("out.json");
  ExpectError(fit + " --model=gxg", 2, "--model 'gxg' is unknown; did you mean ggx?");
  ExpectError(fit + " --model=ggx --lobes=3", 2, "--lobes = 3; must be 1 to 2");
  ExpectError(fit + " --model=ggx --samples=0", 2, "--samples = 0; must be >= 1");
  ExpectError(fit + " --model=ggx --hidden=5", 2, "--hidden is a flag of networks");
  ExpectError(fit + " --model=ggx --trace=" + Path("t.csv"), 2, "--trace is a flag of networks");
  ExpectError(fit + " --lobes=2", 2, "--lobes is a flag of --model");
  ExpectError("fit --model=ggx --material=builtin:blue-plastic --out=" + Path("out"), 2,
              "out: a model is written to a FILE.json");
  EXPECT_FALSE(std::filesystem::exists(Path("out.json")));
  ExpectError("info ggx:alpa=0.1", 1, "ggx: no parameter 'alpa'; did you mean alpha?");
  ExpectError("info gxg:alpha=0.1", 1, "model 'gxg' is unknown; did you mean ggx?");
  WriteBytes(Path("bad.json"), "{}");
  ExpectError("eval --material=builtin:blue-plastic --fit=" + Path("bad.json"), 1,
              "bad.json: not an analytic model");
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

TEST_F(Cli, ANetworkIsAMaterialToo) {
  ASSERT_EQ(
      Run("fit --material=builtin:spectralon" + kQuick + "--out=" + Path("a.safetensors")).status,
      0);
  EXPECT_EQ(
      Run("tabulate --material=" + Path("a.safetensors") + " --out=" + Path("a.binary")).status, 0);
  EXPECT_THAT(Run("info " + Path("a.binary")).out, HasSubstr("1111326 of 1458000 bins valid"));
  EXPECT_EQ(
      Run("fit --material=" + Path("a.safetensors") + kQuick + "--out=" + Path("b.safetensors"))
          .status,
      0);
}

// A network 6-1-1-3 whose kernels are 0 and whose last bias is 0.1.
TEST_F(Cli, APublishedNetworkIsAMaterialAndAFit) {
  const auto write = [&](const std::string& name, const std::string& shape, int count, double x) {
    WriteBytes(Path(name + ".npy"), NpyBytes(NpyHeader("<f4", shape),
                                             ElementBytes<float>(std::vector<double>(count, x))));
  };
  write("fc1", "6, 1", 6, 0.0), write("fc2", "1, 1", 1, 0.0), write("fc3", "1, 3", 3, 0.0);
  write("b1", "1,", 1, 0.0), write("b2", "1,", 1, 0.0), write("b3", "3,", 3, 0.1);
  const std::string network = Path("fc1.npy");
  EXPECT_THAT(Run("info " + network).out,
              HasSubstr("neural BRDF 6-1-1-3 relu, cartesian encoding"));
  EXPECT_EQ(Run("tabulate --material=" + network + " --out=" + Path("a.binary")).status, 0);
  const Result eval =
      Run("eval --json --eval_samples=500 --fit=" + network + " --material=" + network);
  EXPECT_EQ(json::parse(eval.out)["mean_abs_log_error"], 0.0);
  EXPECT_EQ(Run("fit --material=" + network + kQuick + "--out=" + Path("b.safetensors")).status, 0);
  WriteBytes(Path("bad.h5"), "x");
  ExpectError("info " + Path("bad.h5"), 1, "bad.h5: not an HDF5 file");
}

// Every command takes it: info, fit, eval, tabulate and values at one pair.
TEST_F(Cli, ARglFileIsAMaterial) {
  WriteBytes(Path("a.bsdf"), ConstantFile(1, {0.8f, 0.4f, 0.2f}).Bytes());
  const std::string material = " --material=" + Path("a.bsdf");
  EXPECT_THAT(Run("info " + Path("a.bsdf")).out, HasSubstr("RGL measurement, isotropic, RGB"));
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const Result eval =
      Run("eval --json --eval_samples=500 --fit=" + Path("a.safetensors") + material);
  EXPECT_EQ(json::parse(eval.out)["samples"], 500);
  ASSERT_EQ(Run("tabulate" + material + " --out=" + Path("a.binary")).status, 0);
  // The table is reciprocal, this file isn't: equal angles.
  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.4,0,0.4,1\n");
  for (const std::string& source : {material, " --material=" + Path("a.binary")}) {
    const Result values = Run("values" + source + " --out=- --directions=" + Path("pairs.csv"));
    const std::vector<std::string> row = Split(Split(values.out, '\n')[1], ',');
    EXPECT_NEAR(ParseNumber("r", row[4]), 0.8 / (4 * kPi * std::cos(0.4)), 1e-4);
    EXPECT_NEAR(ParseNumber("b", row[6]), 0.2 / (4 * kPi * std::cos(0.4)), 1e-4);
  }
  WriteBytes(Path("bad.bsdf"), "tensor");
  ExpectError("info " + Path("bad.bsdf"), 1, "bad.bsdf: not a tensor file");
}

// A Lambertian of albedo 0.5, in one channel, by angles or as what `values` itself writes.
TEST_F(Cli, ScatteredMeasurementsAreAMaterial) {
  std::string csv = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n";
  for (int theta_i = 5; theta_i < 85; theta_i += 10) {
    for (int theta_o = 0; theta_o < 85; theta_o += 10) {
      for (int phi = 0; phi < 360; phi += 30) {
        csv += StrCat(theta_i, ",0,", theta_o, ",", phi, ",", 0.5 / kPi, "\n");
      }
    }
  }
  WriteBytes(Path("a.csv"), csv);
  const std::string material = " --material=" + Path("a.csv");
  EXPECT_THAT(Run("info " + Path("a.csv")).out,
              HasSubstr("CSV measurements, isotropic, one channel, 864 measurements"));
  const Result fit =
      Run("fit" + material + kQuick + "--max_iterations=20 --out=" + Path("a.safetensors") +
          " --summary=" + Path("a.json"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("neural BRDF 6-5-1 tanh, merl encoding, 41 weights"));
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(summary["samples"], 864 / 8);  // all that are held out
  EXPECT_LT(summary["mean_abs_log_error"], 0.001);
  const Result eval = Run("eval --json --fit=" + Path("a.safetensors") + material);
  EXPECT_EQ(json::parse(eval.out)["samples"], 864 / 8);
  EXPECT_EQ(Run("tabulate" + material + " --out=" + Path("a.binary")).status, 0);

  WriteBytes(Path("pairs.csv"),
             "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n0.2,0,0.5,1\n0.1,0,0.5,1\n");
  ASSERT_EQ(Run("values" + material + " --out=" + Path("values.csv") +
                " --directions=" + Path("pairs.csv"))
                .status,
            0);
  EXPECT_THAT(Run("info " + Path("values.csv")).out, HasSubstr("RGB, 3 measurements"));

  ExpectError("fit" + material + " --terms=log,chromaticity --out=" + Path("out"), 1,
              "a.csv: terms: chromaticity is of no use to a single channel");
  ExpectError("fit" + material + " --init=" + Path("a.safetensors") + " --out=" + Path("out"), 1,
              "a network 6-5-1 tanh, merl encoding; --init needs 6-21-21-1 tanh");
  WriteBytes(Path("bad.csv"), csv + "5,0,5");
  ExpectError("info " + Path("bad.csv"), 1, "bad.csv: line 866: the last line has no end");
  WriteBytes(Path("bad.alta"), "#DIM 1 1\n");
  ExpectError("tabulate --material=" + Path("bad.alta") + " --out=" + Path("out"), 1,
              "bad.alta: no measurements in it");
}

// An albedo of 0.99 is asked to be 0.495: half of everything.
TEST_F(Cli, EveryCommandScalesTheMaterial) {
  const std::string half = " --material=builtin:spectralon --scale_to_albedo=0.495 ";
  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n");
  const auto value = [&](const std::string& material) {
    const Result result = Run("values" + material + " --out=- --directions=" + Path("pairs.csv"));
    EXPECT_EQ(result.status, 0) << result.err;
    return ParseNumber("b", Split(Split(result.out, '\n')[1], ',').back());
  };
  EXPECT_NEAR(value(half), 0.495 / kPi, 1e-4);

  ASSERT_EQ(Run("tabulate" + half + "--out=" + Path("half.binary")).status, 0);
  EXPECT_NEAR(value(" --material=" + Path("half.binary")), 0.495 / kPi, 1e-4);

  ASSERT_EQ(Run("fit" + half + kQuick + "--max_iterations=30 --out=" + Path("a.safetensors") +
                " --summary=" + Path("a.json"))
                .status,
            0);
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(summary["scale_to_albedo"], 0.495);
  EXPECT_THAT(summary["problem"], HasSubstr("--scale_to_albedo=0.495\n"));
  EXPECT_EQ(NeuralBrdf::Read(Path("a.safetensors")).metadata().at("scale_to_albedo"), "0.495");
  EXPECT_NEAR(value(" --material=" + Path("a.safetensors")), 0.495 / kPi, 2e-3);

  const auto error = [&](const std::string& material) {
    const Result eval =
        Run("eval --json --eval_samples=500 --fit=" + Path("a.safetensors") + material);
    return json::parse(eval.out)["mean_abs_log_error"].get<double>();
  };
  EXPECT_LT(error(half), 0.003);
  EXPECT_GT(error(" --material=builtin:spectralon"), 0.02);
}

TEST_F(Cli, MaterialsThatCannotBeScaledAreNamed) {
  const std::string scale = " --scale_to_albedo=0.99 --out=" + Path("out");
  WriteBytes(Path("black.csv"),
             "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n"
             "black,,r,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "black,,g,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "black,,b,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n");
  ExpectError("tabulate --material=sgd:" + Path("black.csv") + "#black" + scale, 1,
              "black.csv#black: can't be scaled to an albedo of 0.99");
  for (const char* command : {"tabulate", "values --directions=-", "eval --fit=x"}) {
    ExpectError(StrCat(command, " --material=builtin:satin-gold --scale_to_albedo=-1") +
                    (command[0] == 'e' ? "" : " --out=" + Path("out")),
                2, "--scale_to_albedo = -1; must be finite and >= 0");
  }
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
