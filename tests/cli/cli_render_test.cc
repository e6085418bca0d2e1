// pbnbrdf render, and the scenes that ship.
#include "cli/cli_fixture.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/image/png.h"

namespace pbnbrdf {
namespace {

const std::string kScenes = std::string(PBNBRDF_PROBLEMS) + "/scenes/";

class CliRender : public Cli {
 protected:
  // A shipped scene with few pixels.
  std::string Small(const std::string& name) const {
    json scene = json::parse(ReadFile(kScenes + name, 1 << 20));
    scene["film"] = {{"width", 16}, {"height", 12}};
    WriteBytes(Path(name), scene.dump());
    return " --scene=" + Path(name) + " ";
  }
};

TEST_F(CliRender, WritesTheImageAndHowItWasMade) {
  const std::string render = "render" + Small("sphere.json") + "--samples_per_pixel=4 --seed=5 ";
  const Result result = Run(render + "--out=" + Path("a.exr") + " --png=" + Path("a.png"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("a.exr: 16 x 12 pixels, 768 samples, "));
  const Image image = ReadExr(Path("a.exr"));
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.height, 12);
  EXPECT_EQ(ReadPng(Path("a.png")).width, 16);
  const std::string bytes = ReadFile(Path("a.exr"), 1 << 20);
  for (const char* text : {"pbnbrdf:seed", "pbnbrdf:scene", "pbnbrdf:version", "pbnbrdf:samples",
                           "pbnbrdf:max_bounces", "sphere.json"}) {
    EXPECT_THAT(bytes, HasSubstr(text));
  }
  ASSERT_EQ(Run(render + "--threads=1 --quiet --out=" + Path("b.exr")).out, "");
  EXPECT_EQ(image.rgb, ReadExr(Path("b.exr")).rgb);
}

TEST_F(CliRender, TakesAnotherEnvironmentAndOtherMaterials) {
  Image map(4, 2);
  map.rgb.assign(map.rgb.size(), 0.25f);
  WriteExr(Path("map.exr"), map);
  const Result result = Run("render" + Small("sphere.json") +
                            "--samples_per_pixel=4 --environment=" + Path("map.exr") +
                            " --material=surface=builtin:spectralon --out=" + Path("a.exr"));
  ASSERT_EQ(result.status, 0) << result.err;
  const Image image = ReadExr(Path("a.exr"));
  EXPECT_EQ(image.pixel(0, 0)[1], 0.25f);                // beside the sphere
  EXPECT_NEAR(image.pixel(8, 6)[2], 0.99 * 0.25, 0.06);  // on it; gold would be at 0.09
}

TEST_F(CliRender, ShippedScenesRender) {
  for (const char* name :
       {"sphere.json", "furnace.json", "cove.json", "gallery.json", "one_of_many.json"}) {
    const Result result =
        Run("render" + Small(name) + "--samples_per_pixel=2 --out=" + Path("a.exr"));
    EXPECT_EQ(result.status, 0) << name << ": " << result.err;
    float sum = 0.0f;
    for (float value : ReadExr(Path("a.exr")).rgb) sum += value;
    EXPECT_GT(sum, 0.0f) << name;
  }
}

TEST_F(CliRender, CountsWhatItLeavesOut) {
  ASSERT_EQ(Run("fit --material=builtin:satin-gold --out=" + Path("a.safetensors") + kQuick).status,
            0);
  const std::string render =
      "render" + Small("sphere.json") + "--samples_per_pixel=8 --max_bounces=2" +
      " --material=surface=" + Path("a.safetensors") + " --summary=" + Path("summary.json");
  const Result with = Run(render + " --out=" + Path("a.exr"));
  ASSERT_EQ(with.status, 0) << with.err;
  const json least = json::parse(ReadFile(Path("summary.json"), 1 << 20));
  for (const char* text : {"\n  materials ", "\n  samples ", "\n  path_vertices ", "\n  rays ",
                           "\n  brdf_values ", " ended\n", " unlit (saved about "}) {
    EXPECT_THAT(with.out, HasSubstr(text));
  }
  ASSERT_EQ(Run(render + " --no_skip --quiet --out=" + Path("b.exr")).out, "");
  const json most = json::parse(ReadFile(Path("summary.json"), 1 << 20));
  // A network gives the same values in whatever batch it is asked for them.
  EXPECT_EQ(ReadExr(Path("a.exr")).rgb, ReadExr(Path("b.exr")).rgb);
  EXPECT_EQ(least["image_samples"], 16 * 12 * 8);
  EXPECT_GT(least["brdf_values"]["skipped"]["below_horizon"], 0);
  EXPECT_GT(least["brdf_values"]["seconds_saved_estimate"], 0.0);
  for (const char* kind : {"materials", "rays", "brdf_values"}) {
    EXPECT_EQ(least[kind]["needed"], most[kind]["needed"]) << kind;
    EXPECT_EQ(least[kind]["needed"], least[kind]["done"]) << kind;
    std::int64_t skipped = 0;
    for (const auto& [reason, count] : least[kind]["skipped"].items()) {
      skipped += std::int64_t(count);
      EXPECT_EQ(most[kind]["skipped"][reason], 0) << kind << " " << reason;
    }
    EXPECT_EQ(std::int64_t(least[kind]["done"]) + skipped, most[kind]["done"]) << kind;
  }
}

TEST_F(CliRender, StopsAtTheTargetError) {
  const Result result =
      Run("render" + Small("furnace.json") + "--samples_per_pixel=200 --target_error=0.1 " +
          "--out=" + Path("a.exr") + " --summary=" + Path("summary.json"));
  ASSERT_EQ(result.status, 0) << result.err;
  const json summary = json::parse(ReadFile(Path("summary.json"), 1 << 20));
  const std::int64_t taken = summary["samples"]["done"];
  EXPECT_LT(taken, 16 * 12 * 200);
  EXPECT_EQ(taken + std::int64_t(summary["samples"]["skipped"]["converged"]), 16 * 12 * 200);
  EXPECT_EQ(summary["image_samples"], taken);
  EXPECT_THAT(ReadFile(Path("a.exr"), 1 << 20), HasSubstr("pbnbrdf:target_error"));
}

// No surface is brighter than its light if no albedo is above 1 (render_test.cc says why): a
// network that is certified to conserve energy, in a box, over 64 reflections.
TEST_F(CliRender, ACertifiedNetworkGainsNothingInTheCove) {
  const Result fit = Run(
      "fit --material=builtin:satin-gold --scale_to_albedo=0.99 --samples=500 --max_iterations=10 "
      "--hidden=5 --terms=log,energy --out=" +
      Path("a.safetensors") + " --summary=" + Path("a.json"));
  ASSERT_EQ(fit.status, 0) << fit.err;
  const json summary = json::parse(ReadFile(Path("a.json"), 1 << 20));
  ASSERT_LE(double(summary["max_directional_albedo"]), 1.0 + 1e-6);
  ASSERT_GE(double(summary["max_directional_albedo"]), 0.8);
  const Result render =
      Run("render" + Small("cove.json") + "--samples_per_pixel=256 --max_bounces=64 " +
          "--material=walls=" + Path("a.safetensors") + " --out=" + Path("a.exr"));
  ASSERT_EQ(render.status, 0) << render.err;
  const Image image = ReadExr(Path("a.exr"));
  const double light = json::parse(ReadFile(Path("cove.json"), 1 << 20))["lights"][0]["radiance"];
  for (int y = 0; y < image.height; ++y) {
    double sum = 0.0, squares = 0.0;
    for (int x = 0; x < image.width; ++x) {
      const double value = image.pixel(x, y)[0];
      sum += value / image.width;
      squares += value * value / image.width;
    }
    EXPECT_LE(sum, light + 3.0 * std::sqrt((squares - sum * sum) / image.width)) << "row " << y;
    EXPECT_GT(sum, 0.0);
  }
}

TEST_F(CliRender, Errors) {
  const std::string render = "render" + Small("sphere.json"), out = " --out=" + Path("out");
  ExpectError("render" + out, 2, "--scene is required");
  ExpectError(render, 2, "--out is required");
  ExpectError(render + "--samples_per_pixel=0" + out, 2,
              "--samples_per_pixel = 0; must be 1 to 16777216");
  ExpectError(render + "--max_bounces=-1" + out, 2, "--max_bounces = -1; must be 0 to 100000");
  ExpectError(render + "--target_error=-1" + out, 2,
              "--target_error = -1; must be finite and >= 0");
  ExpectError(render + "--threads=-1" + out, 2, "--threads = -1; must be >= 0");
  ExpectError(render + "--exposure=0" + out, 2, "--exposure = 0; must be finite and > 0");
  ExpectError(render + "--estimator=mi" + out, 2,
              "--estimator=mi is not one of mis | brdf | light");
  ExpectError(render + "--material=surface" + out, 2, "of the form NAME=SOURCE");
  ExpectError(render + "--material='surface=ggx:alpha=0.3;surface=x'" + out, 2, "is given twice");
  ExpectError(render + "--png=" + Path("out") + out, 2, "--out and --png name the same file");
  ExpectError(render + "--summary=" + Path("out") + out, 2,
              "--out and --summary name the same file");
  ExpectError(render + "--material=surfac=ggx:alpha=0.3" + out, 1,
              "sphere.json: materials: 'surfac' isn't known; did you mean 'surface'?");
  ExpectError(render + "--material=surface=none.binary" + out, 1,
              "sphere.json: materials.surface: none.binary: no such file");
  ExpectError(render + "--environment=" + Path("none.exr") + out, 1, "none.exr: no such file");
  ExpectError(render + "--png=" + Path("none/x.png") + out, 1, "cannot write: no folder");
  ExpectError("render --scene=" + Path("none.json") + out, 1, "none.json: no such file");
}

TEST_F(CliRender, ASummaryOnStandardOutputIsJsonAlone) {
  const Result result = Run("render --samples_per_pixel=1 --summary=- --scene=" + kScenes +
                            "sphere.json --out=" + Path("out.exr"));
  EXPECT_TRUE(json::parse(result.out).contains("seconds")) << result.err;
  EXPECT_TRUE(std::filesystem::exists(Path("out.exr")));
}

}  // namespace
}  // namespace pbnbrdf
