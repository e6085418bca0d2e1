// Every kind of material through the commands.
#include <sys/stat.h>

#include <cmath>
#include <thread>

#include "cli/cli_fixture.h"
#include "pbnbrdf/network/neural_brdf.h"
#include "sources/npy_writer.h"
#include "sources/rgl_writer.h"

namespace pbnbrdf {
namespace {

using CliSources = Cli;

TEST_F(CliSources, BadMaterialsExitWith1) {
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
  ExpectError("export --format=merl --material=" + Path("none.binary") + " --out=" + Path("out"), 1,
              "no such file");
  ExpectError("measure --material=builtin:satin-gold --fit=" + Path("none.safetensors"), 1,
              "no such file");
  ExpectError("info " + Path("none.binary"), 1, "no such file");
}

TEST_F(CliSources, PipesAreFiles) {
  ASSERT_EQ(
      Run("fit --material=builtin:spectralon" + kQuick + "--out=" + Path("a.safetensors")).status,
      0);
  WriteBytes(Path("a.csv"), "theta_i,phi_i,theta_o,phi_o,value\n0.5,0,0.4,3,0.2\n");
  for (const std::string name : {"a.safetensors", "a.csv"}) {
    const std::string file = Path(name), pipe = Path("pipe-" + name);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { WriteBytes(pipe, ReadFile(file, 1 << 20)); });
    const Result of_pipe = Run("info " + pipe);
    writer.join();
    ASSERT_EQ(of_pipe.status, 0) << of_pipe.err;
    const std::string of_file = Run("info " + file).out;
    EXPECT_EQ(of_pipe.out.substr(pipe.size()), of_file.substr(file.size()));
  }
}

// A scan from each of four angles, in the plane of incidence; with `tilt`, also out of it.
std::string Scan(bool tilt) {
  std::string csv = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n";
  for (int theta_i : {10, 30, 50, 70}) {
    for (int k = 0; k < 16; ++k) {
      csv += StrCat(theta_i, ",0,", 5 * k, ",180,0.1\n");
      if (tilt) csv += StrCat(theta_i, ",0,", 5 * k, ",", 10 * k, ",0.1\n");
    }
  }
  return csv;
}

TEST_F(CliSources, WhatWasMeasuredOfTheHemisphereIsSaid) {
  WriteBytes(Path("plane.csv"), Scan(false));
  WriteBytes(Path("all.csv"), Scan(true));
  const std::string note = "only a plane was measured: what lies beside it is a guess";
  std::vector<double> parts;
  for (const bool in_plane : {true, false}) {
    const std::string file = Path(in_plane ? "plane.csv" : "all.csv");
    const Result fit = Run("fit --material=" + file + kQuick + "--summary=" + Path("s.json") +
                           " --out=" + Path("a.safetensors"));
    ASSERT_EQ(fit.status, 0) << fit.err;
    EXPECT_EQ(fit.out.find(note) != std::string::npos, in_plane) << fit.out;
    const json summary = json::parse(ReadFile(Path("s.json"), 1 << 20));
    EXPECT_EQ(summary["measured_in_plane"], in_plane);
    parts.push_back(summary["measured_part"]);
    const std::string info = Run("info " + file).out;
    EXPECT_EQ(info.find(note) != std::string::npos, in_plane) << info;
    EXPECT_THAT(info, HasSubstr(StrCat("  measured near ", std::lround(100.0 * parts.back()),
                                       " % of all pairs of directions\n")));
  }
  EXPECT_GT(parts[0], 0.05);
  EXPECT_LT(parts[0], parts[1]);
  EXPECT_LT(parts[1], 1.0);
  EXPECT_THAT(Run("info builtin:satin-gold").out, Not(HasSubstr("pairs of directions")));
}

TEST_F(CliSources, AModelFitIsASourceAndAFit) {
  const std::string material = " --material=builtin:blue-plastic";
  const Result fit = Run("fit-model --model=ggx --samples=500 --starts=3 --seed=4" + material +
                         " --out=" + Path("a.json"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_EQ(fit.err, "");
  EXPECT_THAT(fit.out, HasSubstr("a.json: ggx:rho_d="));
  EXPECT_THAT(fit.out, HasSubstr("mean_abs_log_error"));
  EXPECT_THAT(fit.out, Not(HasSubstr("not reciprocal")));
  const json file = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(file["model"], "ggx");
  EXPECT_EQ(file["seed"], 4);
  EXPECT_EQ(file["samples"], 500);
  EXPECT_EQ(file["material"], "builtin:blue-plastic");
  EXPECT_EQ(file["version"], Split(Split(Run("--version").out, '\n')[0], ' ')[1]);
  EXPECT_NEAR(file["parameters"]["alpha_x"], 0.05, 0.002);  // blue-plastic's
  EXPECT_LT(file["errors"]["mean_abs_log_error"], 0.01);
  WriteBytes(Path("again.flags"), file["problem"]);
  ASSERT_EQ(Run("fit-model --quiet --flagfile=" + Path("again.flags") + " --out=" + Path("b.json"))
                .status,
            0);
  EXPECT_EQ(json::parse(ReadFile(Path("b.json"), 1 << 20))["parameters"], file["parameters"]);

  const Result measured = Run("measure --json --samples=2000 --fit=" + Path("a.json") + material);
  ASSERT_EQ(measured.status, 0) << measured.err;
  const json measures = json::parse(measured.out);
  EXPECT_EQ(measures["parameters"], 11);
  EXPECT_LT(measures["mean_abs_log_error"], 0.01);
  EXPECT_EQ(measures["hrl"], 0.0);

  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n");
  const std::string directions = " --out=- --directions=" + Path("pairs.csv");
  EXPECT_EQ(Run("eval --material=" + Path("a.json") + directions).out,
            Run("eval --material=" + std::string(file["source"]) + directions).out);
  EXPECT_EQ(Run("export --format=merl --material=" + Path("a.json") + " --out=" + Path("a.binary"))
                .status,
            0);
  const Result info = Run("info " + Path("a.json"));
  EXPECT_THAT(info.out, HasSubstr("Walter et al. 2007"));
  EXPECT_THAT(info.out, HasSubstr("  seed: 4\n"));
  ASSERT_EQ(Run("fit" + kQuick + "--material=" + Path("a.json") + " --out=" + Path("n.safetensors"))
                .status,
            0);
}

TEST_F(CliSources, EveryModelFits) {
  const std::string listed = Run("info models:").out, help = Run("fit-model --help").out;
  for (const char* model :
       {"lambert", "oren_nayar", "phong", "blinn_phong", "lafortune", "ward", "ward_duer",
        "ward_bounded", "cook_torrance", "ggx", "abc", "disney", "principled"}) {
    EXPECT_THAT(listed, HasSubstr(StrCat("\n", model, ": (")));
    EXPECT_THAT(help, HasSubstr(StrCat(" ", model)));
    const std::string out = Path(StrCat(model, ".json"));
    const Result fit = Run(StrCat("fit-model --quiet --samples=200 --starts=2 --max_iterations=5 ",
                                  "--lobes=2 --model=", model,
                                  " --material=builtin:red-satin-plastic --out=", out));
    EXPECT_EQ(fit.status, 0) << fit.err;
    EXPECT_EQ(fit.out + fit.err, "") << model;
    EXPECT_THAT(Run("info " + out).out, HasSubstr(StrCat(": ", model, ":")));
  }
}

TEST_F(CliSources, ModelMistakesAreNamed) {
  const std::string fit = "fit-model --material=builtin:blue-plastic --out=" + Path("out.json");
  ExpectError(fit, 2, "--model is required");
  ExpectError(fit + " --model=gxg", 2, "--model 'gxg' is unknown; did you mean ggx?");
  ExpectError(fit + " --model=ggx --lobes=3", 2, "--lobes = 3; must be 1 to 2");
  ExpectError(fit + " --model=ggx --samples=0", 2, "--samples = 0; must be 1 to");
  ExpectError(fit + " --model=ggx --hidden=5", 2, "--hidden is not a flag");
  ExpectError(fit + " --model=ggx --trace=" + Path("t.csv"), 2, "--trace is not a flag");
  ExpectError("fit-model --model=ggx --material=builtin:blue-plastic --out=" + Path("out"), 2,
              "out: a model is written to a FILE.json");
  EXPECT_FALSE(std::filesystem::exists(Path("out.json")));
  ExpectError("info ggx:alpa=0.1", 1, "ggx: no parameter 'alpa'; did you mean alpha?");
  ExpectError("info gxg:alpha=0.1", 1, "model 'gxg' is unknown; did you mean ggx?");
  WriteBytes(Path("bad.json"), "{}");
  ExpectError("measure --material=builtin:blue-plastic --fit=" + Path("bad.json"), 1,
              "bad.json: not an analytic model");
  ExpectError("measure --material=builtin:blue-plastic --fit=builtin:blue-plastic", 1,
              "builtin:blue-plastic: neither a fitted network nor an analytic model");
}

TEST_F(CliSources, ANetworkIsAMaterialToo) {
  ASSERT_EQ(
      Run("fit --material=builtin:spectralon" + kQuick + "--out=" + Path("a.safetensors")).status,
      0);
  EXPECT_EQ(
      Run("export --format=merl --material=" + Path("a.safetensors") + " --out=" + Path("a.binary"))
          .status,
      0);
  EXPECT_THAT(Run("info " + Path("a.binary")).out, HasSubstr("1111326 of 1458000 bins valid"));
  EXPECT_EQ(
      Run("fit --material=" + Path("a.safetensors") + kQuick + "--out=" + Path("b.safetensors"))
          .status,
      0);
}

// A network 6-1-1-3 whose kernels are 0 and whose last bias is 0.1.
TEST_F(CliSources, APublishedNetworkIsAMaterialAndAFit) {
  const auto write = [&](const std::string& name, const std::string& shape, int count, double x) {
    WriteBytes(Path(name + ".npy"), NpyBytes(NpyHeader("<f4", shape),
                                             ElementBytes<float>(std::vector<double>(count, x))));
  };
  write("fc1", "6, 1", 6, 0.0), write("fc2", "1, 1", 1, 0.0), write("fc3", "1, 3", 3, 0.0);
  write("b1", "1,", 1, 0.0), write("b2", "1,", 1, 0.0), write("b3", "3,", 3, 0.1);
  const std::string network = Path("fc1.npy");
  EXPECT_THAT(Run("info " + network).out,
              HasSubstr("neural BRDF 6-1-1-3 relu, cartesian encoding"));
  EXPECT_EQ(Run("export --format=merl --material=" + network + " --out=" + Path("a.binary")).status,
            0);
  const Result measured =
      Run("measure --json --samples=500 --fit=" + network + " --material=" + network);
  EXPECT_EQ(json::parse(measured.out)["mean_abs_log_error"], 0.0);
  EXPECT_EQ(Run("fit --material=" + network + kQuick + "--out=" + Path("b.safetensors")).status, 0);
  WriteBytes(Path("bad.h5"), "x");
  ExpectError("info " + Path("bad.h5"), 1, "bad.h5: not an HDF5 file");
}

// Every command takes it: info, fit, measure, export and eval at one pair.
TEST_F(CliSources, ARglFileIsAMaterial) {
  WriteBytes(Path("a.bsdf"), ConstantFile(1, {0.8f, 0.4f, 0.2f}).Bytes());
  const std::string material = " --material=" + Path("a.bsdf");
  EXPECT_THAT(Run("info " + Path("a.bsdf")).out, HasSubstr("RGL measurement, isotropic, RGB"));
  ASSERT_EQ(Run("fit" + material + kQuick + "--out=" + Path("a.safetensors")).status, 0);
  const Result measured =
      Run("measure --json --samples=500 --fit=" + Path("a.safetensors") + material);
  EXPECT_EQ(json::parse(measured.out)["samples"], 500);
  ASSERT_EQ(Run("export --format=merl" + material + " --out=" + Path("a.binary")).status, 0);
  // The table is reciprocal, this file isn't: equal angles.
  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.4,0,0.4,1\n");
  for (const std::string& source : {material, " --material=" + Path("a.binary")}) {
    const Result values = Run("eval" + source + " --out=- --directions=" + Path("pairs.csv"));
    const std::vector<std::string> row = Split(Split(values.out, '\n')[1], ',');
    EXPECT_NEAR(ParseNumber("r", row[4]), 0.8 / (4 * kPi * std::cos(0.4)), 1e-4);
    EXPECT_NEAR(ParseNumber("b", row[6]), 0.2 / (4 * kPi * std::cos(0.4)), 1e-4);
  }
  WriteBytes(Path("bad.bsdf"), "tensor");
  ExpectError("info " + Path("bad.bsdf"), 1, "bad.bsdf: not a tensor file");
}

// A Lambertian of albedo 0.5, in one channel, by angles or as what `eval` itself writes.
TEST_F(CliSources, ScatteredMeasurementsAreAMaterial) {
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
  EXPECT_THAT(fit.out, HasSubstr("neural BRDF 6-5-1 tanh, elevations encoding, 41 weights"));
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  EXPECT_EQ(summary["samples"], 864 / 8);  // all that are held out
  EXPECT_LT(summary["mean_abs_log_error"], 0.001);
  const Result measured = Run("measure --json --fit=" + Path("a.safetensors") + material);
  EXPECT_EQ(json::parse(measured.out)["samples"], 864 / 8);
  EXPECT_EQ(Run("export --format=merl" + material + " --out=" + Path("a.binary")).status, 0);

  WriteBytes(Path("pairs.csv"),
             "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n0.2,0,0.5,1\n0.1,0,0.5,1\n");
  ASSERT_EQ(
      Run("eval" + material + " --out=" + Path("values.csv") + " --directions=" + Path("pairs.csv"))
          .status,
      0);
  EXPECT_THAT(Run("info " + Path("values.csv")).out, HasSubstr("RGB, 3 measurements"));

  ExpectError("fit" + material + " --terms=log,chromaticity --out=" + Path("out"), 1,
              "a.csv: terms: chromaticity is of no use to a single channel");
  ExpectError("fit" + material + " --init=" + Path("a.safetensors") + " --out=" + Path("out"), 1,
              "a network 6-5-1 tanh, elevations encoding; --init needs 6-21-21-1 tanh");
  WriteBytes(Path("bad.csv"), csv + "5,0,5");
  ExpectError("info " + Path("bad.csv"), 1, "bad.csv: line 866: 3 columns, expected 5");
  WriteBytes(Path("bad.alta"), "#DIM 1 1\n");
  ExpectError("export --format=merl --material=" + Path("bad.alta") + " --out=" + Path("out"), 1,
              "bad.alta: no measurements in it");
}

// An albedo of 0.99 is asked to be 0.495: half of everything.
TEST_F(CliSources, EveryCommandScalesTheMaterial) {
  const std::string half = " --material=builtin:spectralon --scale_to_albedo=0.495 ";
  WriteBytes(Path("pairs.csv"), "theta_i,phi_i,theta_o,phi_o\n0.3,0,0.5,1\n");
  const auto value = [&](const std::string& material) {
    const Result result = Run("eval" + material + " --out=- --directions=" + Path("pairs.csv"));
    EXPECT_EQ(result.status, 0) << result.err;
    return ParseNumber("b", Split(Split(result.out, '\n')[1], ',').back());
  };
  EXPECT_NEAR(value(half), 0.495 / kPi, 1e-4);

  ASSERT_EQ(Run("export --format=merl" + half + "--out=" + Path("half.binary")).status, 0);
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
    const Result measured =
        Run("measure --json --samples=500 --fit=" + Path("a.safetensors") + material);
    return json::parse(measured.out)["mean_abs_log_error"].get<double>();
  };
  EXPECT_LT(error(half), 0.003);
  EXPECT_GT(error(" --material=builtin:spectralon"), 0.02);
}

TEST_F(CliSources, MaterialsThatCannotBeScaledAreNamed) {
  const std::string scale = " --scale_to_albedo=0.99 --out=" + Path("out");
  WriteBytes(Path("black.csv"),
             "name,other_name,channel,rhoD,rhoS,alpha,p,f0,f1,kap,lambda,c,k,theta0,error\n"
             "black,,r,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "black,,g,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n"
             "black,,b,0,0,0.05,0.5,0.9,0.1,20,2,1e-7,30,0.1,0.1\n");
  ExpectError("export --format=merl --material=sgd:" + Path("black.csv") + "#black" + scale, 1,
              "black.csv#black: can't be scaled to an albedo of 0.99");
  for (const char* command : {"export --format=merl", "eval --directions=-", "measure --fit=x"}) {
    ExpectError(StrCat(command, " --material=builtin:satin-gold --scale_to_albedo=-1") +
                    (command[0] == 'm' ? "" : " --out=" + Path("out")),
                2, "--scale_to_albedo = -1; must be finite and >= 0");
  }
}

}  // namespace
}  // namespace pbnbrdf
