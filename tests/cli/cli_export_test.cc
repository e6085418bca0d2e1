// The command export.
#include <map>

#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

TEST_F(Cli, ExportWritesEveryFormat) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold --encoding=cartesian --activation=relu" +
                kQuick + "--hidden=5,4 --out=" + network)
                .status,
            0);
  const std::map<std::string, std::string> files = {{"npy", "x_fc1.npy"},
                                                    {"h5", "x.h5"},
                                                    {"merl", "x.binary"},
                                                    {"bsdf", "x.bsdf"},
                                                    {"bsdf_spectral", "y.bsdf"},
                                                    {"csv", "x.csv"},
                                                    {"c", "x.h"},
                                                    {"glsl", "x.glsl"},
                                                    {"hlsl", "x.hlsl"},
                                                    {"wgsl", "x.wgsl"},
                                                    {"glsl_half", "y.glsl"},
                                                    {"hlsl_half", "y.hlsl"},
                                                    {"wgsl_half", "y.wgsl"},
                                                    {"gltf", "x.gltf"},
                                                    {"materialx", "x.mtlx"},
                                                    {"mitsuba", "x.py"},
                                                    {"onnx", "x.onnx"},
                                                    {"torch", "y.py"}};
  const std::string help = Run("export --help").out;
  for (const auto& [format, file] : files) {
    EXPECT_THAT(help, HasSubstr("  " + format + " "));
    const Result result =
        Run("export --fit=" + network + " --format=" + format + " --out=" + Path(file));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(std::filesystem::exists(Path(file))) << format;
  }
  EXPECT_THAT(help,
              HasSubstr("npy | h5 | merl | bsdf | bsdf_spectral | csv | c | glsl | hlsl | wgsl"));
  const Result half = Run("export --fit=" + network + " --format=glsl_half --name=x --out=-");
  EXPECT_THAT(half.err, HasSubstr(network + " with weights of half precision: changed by "));
  EXPECT_THAT(half.out, HasSubstr("weights of half precision: changed by "));
  EXPECT_THAT(half.out, HasSubstr("unpackHalf2x16("));
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
              "--format=obj is not one of npy | h5 | merl | bsdf | bsdf_spectral | csv | c | glsl "
              "| hlsl | wgsl");
  ExpectError(to + " --format=c --name=a-b", 1, "a.safetensors, exported as c: name=a-b is not");
  ExpectError("export --format=npy --fit=" + network + " --out=" + Path("x_fc1.npy"), 1,
              "a.safetensors, exported as npy: an NBRDF network has relu units and the cartesian "
              "encoding, this one is tanh, merl");
  ExpectError("export --format=c --fit=" + Path("none.safetensors") + " --out=" + Path("out"), 1,
              "none.safetensors: no such file");
  ExpectError("export --format=mitsuba --fit=" + network + " --out=" + Path("none/x.py"), 1,
              "x.py: cannot write: no folder");
}

// The same file, by a name for any source and by one for networks.
TEST_F(Cli, ExportMakesATableOfAnySource) {
  const std::string network = Path("a.safetensors");
  ASSERT_EQ(Run("fit --material=builtin:satin-gold" + kQuick + "--out=" + network).status, 0);
  for (const char* format : {"merl", "bsdf", "csv"}) {
    for (const auto& [flag, file] : {std::pair("--fit=", "a"), std::pair("--material=", "b")}) {
      const Result result =
          Run(StrCat("export --format=", format, " ", flag, network, " --out=", Path(file)));
      ASSERT_EQ(result.status, 0) << result.err;
    }
    EXPECT_TRUE(ReadFile(Path("a"), 1 << 26) == ReadFile(Path("b"), 1 << 26)) << format;
  }
  EXPECT_EQ(Run("export --format=bsdf --material=builtin:rolled-brass --out=" + Path("brass.bsdf"))
                .status,
            0);
  EXPECT_THAT(Run("info " + Path("brass.bsdf")).out,
              HasSubstr("anisotropic, RGB, 17 x 8 incident directions"));
}

TEST_F(Cli, AnAnisotropicMaterialIsTabulatedByItsIsotropicFit) {
  const std::string brass = " --material=builtin:rolled-brass";
  ExpectError("export --format=merl" + brass + " --out=" + Path("out"), 1,
              "builtin:rolled-brass, exported as merl: anisotropic, and a MERL table has no phi_h");
  ASSERT_EQ(Run("fit" + brass + kQuick + "--encoding=merl --out=" + Path("a.safetensors")).status,
            0);
  EXPECT_EQ(
      Run("export --format=merl --material=" + Path("a.safetensors") + " --out=" + Path("a.binary"))
          .status,
      0);
}

}  // namespace
}  // namespace pbnbrdf
