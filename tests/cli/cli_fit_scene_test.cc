// pbnbrdf fit-scene, and render --fits.
#include <filesystem>

#include "cli/cli_fixture.h"
#include "pbnbrdf/image/exr.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {
namespace {

constexpr char kQuickFit[] = " --samples=500 --max_iterations=8 --hidden=12,12 ";

class CliFitScene : public Cli {
 protected:
  // Gold and plastic on a floor; copper under it, and paper nowhere; the ball far off is a dot.
  json Scene() const {
    const auto ball = [](double x, double y, double z, double radius, const char* material) {
      return json{
          {"type", "sphere"}, {"center", {x, y, z}}, {"radius", radius}, {"material", material}};
    };
    return {{"camera", {{"origin", {0, 2, 6}}, {"target", {0, 0.5, 0}}, {"field_of_view", 40}}},
            {"film", {{"width", 24}, {"height", 16}}},
            {"materials",
             {{"gold", {{"source", "builtin:satin-gold"}}},
              {"floor", {{"source", "builtin:wall-plaster"}, {"scale_to_albedo", 0.5}}},
              {"copper", {{"source", "builtin:brushed-copper"}}},
              {"paper", {{"source", "builtin:glossy-grey-paper"}}},
              {"dot", {{"source", "builtin:red-satin-plastic"}}}}},
            {"shapes",
             {{{"type", "rectangle"},
               {"width", 20},
               {"height", 20},
               {"material", "floor"},
               {"transform", {{{"rotate", {{"axis", {1, 0, 0}}, {"degrees", -90}}}}}}},
              ball(0, 1, 0, 1, "gold"),
              ball(0, -2, 0, 1, "copper"),
              ball(2, 0.1, 0, 0.06, "dot")}},
            {"lights", {{{"type", "environment"}, {"radiance", 0.5}}}}};
  }

  std::string Write(const json& scene) const {
    WriteBytes(Path("scene.json"), scene.dump());
    return " --scene=" + Path("scene.json") + " ";
  }

  json Summary(const std::string& folder) const {
    return json::parse(ReadFile(Path(folder) + "/summary.json", 1 << 20));
  }
};

TEST_F(CliFitScene, FitsWhatTheSceneShows) {
  const Result result =
      Run("fit-scene" + Write(Scene()) + kQuickFit + "--out_dir=" + Path("fits/of/it"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("3 done; skipped: 1 unreferenced, 1 not_reached"));
  const json summary = Summary("fits/of/it");
  EXPECT_EQ(summary["materials"]["needed"], 3);
  EXPECT_EQ(summary["materials"]["skipped"]["not_reached"], 1);
  EXPECT_EQ(summary["materials"]["skipped"]["unreferenced"], 1);
  EXPECT_GT(summary["materials"]["seconds_saved_estimate"], 0.0);
  ASSERT_EQ(summary["fits"].size(), 5u);
  std::map<std::string, json> fits;
  for (const json& fit : summary["fits"]) fits[fit["material"]] = fit;
  for (const char* shown : {"gold", "floor"}) {
    EXPECT_EQ(fits[shown]["hidden"], json({12, 12}));
    EXPECT_GT(fits[shown]["share"], 0.05);
    EXPECT_TRUE(std::filesystem::exists(Path("fits/of/it/") + std::string(shown) + ".safetensors"));
  }
  EXPECT_EQ(fits["floor"]["scale_to_albedo"], 0.5);
  EXPECT_EQ(fits["dot"]["hidden"], json({8, 8}));
  EXPECT_LT(fits["dot"]["sensitivity"], 0.01);
  EXPECT_GT(fits["gold"]["sensitivity"], 0.05);
  EXPECT_THAT(fits["dot"]["why"], HasSubstr("small network"));
  EXPECT_EQ(fits["copper"]["skipped"], "not_reached");
  EXPECT_EQ(fits["paper"]["skipped"], "unreferenced");
  EXPECT_FALSE(std::filesystem::exists(Path("fits/of/it/copper.safetensors")));
  const auto network = NeuralBrdf::Read(Path("fits/of/it/gold.safetensors"));
  EXPECT_EQ(network.metadata().at("material"), "builtin:satin-gold");
  EXPECT_THAT(network.metadata().at("problem"), HasSubstr("--scene_floor=0.5"));
}

// Not what the flags ask for: the dot has a small network and few samples.
TEST_F(CliFitScene, RecordsWhatWasFitted) {
  const Result result = Run("fit-scene" + Write(Scene()) + " --samples=9000 --max_iterations=2 " +
                            "--terms=log --out_dir=" + Path("fits"));
  ASSERT_EQ(result.status, 0) << result.err;
  std::map<std::string, std::string> problems;
  const json summary = Summary("fits");
  for (const json& fit : summary["fits"]) {
    if (fit.contains("problem")) problems[fit["material"]] = fit["problem"];
  }
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_THAT(problems["dot"], HasSubstr("--hidden=8,8\n"));
  EXPECT_THAT(problems["dot"], HasSubstr("--samples=6000\n"));
  EXPECT_THAT(problems["gold"], HasSubstr("--hidden=21,21\n"));
  EXPECT_THAT(problems["gold"], HasSubstr("--samples=9000\n"));
  for (const auto& [name, problem] : problems) {
    EXPECT_THAT(problem, HasSubstr("--encoding=merl\n"));
    EXPECT_THAT(problem, HasSubstr("--scene=" + Path("scene.json") + "\n"));
    EXPECT_EQ(NeuralBrdf::Read(Path("fits/") + name + ".safetensors").metadata().at("problem"),
              problem);
  }
  WriteBytes(Path("dot.flags"), problems["dot"]);
  ASSERT_EQ(Run("fit-scene --quiet --flagfile=" + Path("dot.flags") + " --out_dir=" + Path("again"))
                .status,
            0);
  EXPECT_EQ(NeuralBrdf::Read(Path("again/dot.safetensors")).weights(),
            NeuralBrdf::Read(Path("fits/dot.safetensors")).weights());
}

TEST_F(CliFitScene, WithoutSkippingAllAreFittedAndTheImageIsTheSame) {
  const std::string scene = Write(Scene());
  const std::string fit = "fit-scene" + scene + kQuickFit;
  ASSERT_EQ(Run(fit + "--out_dir=" + Path("few")).status, 0);
  const Result all = Run(fit + "--no_skip --out_dir=" + Path("all"));
  ASSERT_EQ(all.status, 0) << all.err;
  EXPECT_EQ(Summary("all")["materials"]["done"], 5);
  EXPECT_EQ(Summary("all")["materials"]["needed"], 3);
  const std::string render = "render" + scene + "--samples_per_pixel=4 --fits=";
  ASSERT_EQ(Run(render + Path("few") + " --out=" + Path("few.exr")).status, 0);
  ASSERT_EQ(Run(render + Path("all") + " --no_skip --out=" + Path("all.exr")).status, 0);
  ASSERT_EQ(Run("render" + scene + "--samples_per_pixel=4 --out=" + Path("source.exr")).status, 0);
  EXPECT_EQ(ReadExr(Path("few.exr")).rgb, ReadExr(Path("all.exr")).rgb);
  EXPECT_NE(ReadExr(Path("few.exr")).rgb, ReadExr(Path("source.exr")).rgb);
}

TEST_F(CliFitScene, SamplesComeFromTheScene) {
  const std::string fit = "fit-scene" + Write(Scene()) + kQuickFit;
  ASSERT_EQ(Run(fit + "--out_dir=" + Path("a")).status, 0);
  ASSERT_EQ(Run(fit + "--scene_floor=1 --out_dir=" + Path("b")).status, 0);
  ASSERT_EQ(Run("fit --material=builtin:satin-gold" + std::string(kQuickFit) +
                "--out=" + Path("plain.safetensors"))
                .status,
            0);
  const auto weights = [&](const std::string& file) {
    return NeuralBrdf::Read(Path(file)).weights();
  };
  EXPECT_NE(weights("a/gold.safetensors"), weights("plain.safetensors"));
  EXPECT_EQ(weights("b/gold.safetensors").size(), weights("plain.safetensors").size());
}

TEST_F(CliFitScene, RefusesWhatDoesNotGoTogether) {
  const std::string fit = "fit-scene" + Write(Scene());
  ExpectError(fit, 2, "--out_dir is required");
  ExpectError(fit + "--out_dir=x --material=builtin:satin-gold", 2, "--material is not a flag");
  ExpectError(fit + "--out_dir=x --scene_floor=1.5", 2, "--scene_floor = 1.5; must be 0 to 1");
  ExpectError("fit --material=builtin:satin-gold --out=a.safetensors --no_skip", 2,
              "--no_skip is not a flag");
  ExpectError("fit --material=builtin:satin-gold --out=a.safetensors --scene_floor=1", 2,
              "--scene_floor is not a flag");
  ExpectError("fit-scene --out_dir=x", 2, "--scene is required");
}

TEST_F(CliFitScene, NamesTheMaterialAtFault) {
  json scene = Scene();
  scene["materials"]["gold"]["source"] = "gone.binary";
  ExpectError("fit-scene" + Write(scene) + "--out_dir=" + Path("fits"), 1,
              "scene.json: materials.gold: ");
  scene = Scene();
  scene["materials"]["a/b"] = {{"source", "builtin:satin-gold"}};
  ExpectError("fit-scene" + Write(scene) + "--out_dir=" + Path("fits"), 1,
              "materials.a/b: a file can't have this name");
  ExpectError("render" + Write(Scene()) + "--fits=" + Path("none") + " --out=" + Path("out"), 1,
              "has no NAME.safetensors for any material NAME of the scene");
}

}  // namespace
}  // namespace pbnbrdf
