#include "pbnbrdf/render/demand.h"

#include <algorithm>

#include "pbnbrdf/models/analytic.h"
#include "render/render_test_util.h"

namespace pbnbrdf {
namespace {

// A BRDF whose log(1 + f cos_i) is larger by `change` at all directions.
class GrownBrdf final : public PointwiseBrdf {
 public:
  GrownBrdf(std::unique_ptr<Brdf> brdf, double change) : brdf_(std::move(brdf)), change_(change) {}

  std::string Description() const override { return "grown"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    Rgb value;
    brdf_->Evaluate({&pair, 1}, {&value, 1});
    for (double& f : value) {
      f = std::expm1(std::log1p(f * pair.wi.z) + change_) / pair.wi.z;
    }
    return value;
  }

 private:
  std::unique_ptr<Brdf> brdf_;
  double change_;
};

OpenedMaterial OpenUnchanged(const std::string& source) {
  static const Proposal proposal = FitProposal(GgxBrdf({0.5, 0.5, 0.5}, 0.4));
  return {OpenTestMaterial(source), proposal};
}

double MeanLuminance(const Image& image) {
  double sum = 0.0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    sum += 0.2126 * image.rgb[i] + 0.7152 * image.rgb[i + 1] + 0.0722 * image.rgb[i + 2];
  }
  return 3.0 * sum / double(image.rgb.size());
}

// A ball on a floor under a sky and a lamp; a material that nothing has; one under the floor.
Scene BallOnFloor() {
  Scene scene = SceneFrom(5.0, 40.0, 24);
  AddSphere({0.0, 0.0, 0.0}, 1.0, "builtin:satin-gold", &scene);
  AddRectangle({0.0, -1.0, 0.0}, {6.0, 0.0, 0.0}, {0.0, 0.0, -6.0}, "white:0.6", &scene);
  AddSphere({0.0, -3.0, 0.0}, 0.5, "builtin:blue-plastic", &scene);
  scene.materials.push_back({"spare", "builtin:no-such-material"});
  scene.environment = EnvironmentMap::Constant({0.3, 0.4, 0.5});
  scene.point_lights.push_back({{2.0, 3.0, 2.0}, {9.0, 8.0, 7.0}});
  return scene;
}

TEST(Demand, SaysWhatIsReached) {
  const auto demand = MeasureDemand(BallOnFloor(), OpenUnchanged);
  ASSERT_EQ(demand.size(), 4u);
  for (int shown : {0, 1}) {
    EXPECT_TRUE(demand[shown].referenced && demand[shown].reached);
    EXPECT_GT(demand[shown].share, 0.05);
    EXPECT_NE(demand[shown].angles, nullptr);
  }
  EXPECT_TRUE(demand[2].referenced);
  EXPECT_FALSE(demand[3].referenced);
  for (int hidden : {2, 3}) {
    EXPECT_FALSE(demand[hidden].reached);
    EXPECT_EQ(demand[hidden].share, 0.0);
    EXPECT_EQ(demand[hidden].sensitivity, 0.0);
    EXPECT_EQ(demand[hidden].angles, nullptr);
  }
}

// A convex shape under a directional light reflects all of its light once.
TEST(Demand, SharesAddUpWhereLightIsReflectedOnce) {
  Scene scene = SceneFrom(5.0, 40.0, 24);
  AddSphere({-1.1, 0.0, 0.0}, 1.0, "white:0.5", &scene);
  AddSphere({30.0, 0.0, 0.0}, 1.0, "white:0.4", &scene);
  AddSphere({1.1, 0.0, 0.0}, 1.0, "builtin:satin-gold", &scene);
  scene.directional_lights.push_back({{0.0, 0.0, -1.0}, {1.0, 1.0, 1.0}});
  const auto demand = MeasureDemand(scene, OpenUnchanged, {.max_bounces = 1});
  EXPECT_NEAR(demand[0].share + demand[2].share, 1.0, 1e-12);
  EXPECT_GT(demand[0].share, 0.1);
  EXPECT_EQ(demand[1].share, 0.0);
  const auto twice = MeasureDemand(scene, OpenUnchanged, {.max_bounces = 2});
  EXPECT_GT(twice[0].share + twice[2].share, 1.001);  // some went from one to the other
}

// The derivative of the image's luminance, by finite differences of the material.
TEST(Demand, SensitivityIsTheImagesDerivative) {
  constexpr double kChange = 1e-4;
  const Scene scene = BallOnFloor();
  const DemandOptions options = {.paths = 64 * 24 * 24, .seed = 3, .max_bounces = 3};
  const auto demand = MeasureDemand(scene, OpenUnchanged, options);
  for (std::size_t changed : {0, 1}) {
    const auto luminance = [&](double change) {
      const MaterialOpener open = [&](const std::string& source) -> OpenedMaterial {
        OpenedMaterial opened = OpenUnchanged(source);
        if (source == scene.materials[changed].source) {
          opened.brdf = std::make_unique<GrownBrdf>(std::move(opened.brdf), change);
        }
        return opened;
      };
      const RenderOptions render = {.samples_per_pixel = 64, .seed = 3, .max_bounces = 3};
      return MeanLuminance(Render(scene, open, render).image);
    };
    const double derivative =
        (luminance(kChange) - luminance(-kChange)) / (2.0 * kChange) / luminance(0.0);
    EXPECT_GT(derivative, 0.01);
    EXPECT_NEAR(demand[changed].sensitivity, derivative, 0.003 * derivative) << changed;
  }
}

TEST(Demand, DoesNotDependOnThreads) {
  const auto one = MeasureDemand(BallOnFloor(), OpenUnchanged, {.seed = 7, .threads = 1});
  const auto many = MeasureDemand(BallOnFloor(), OpenUnchanged, {.seed = 7, .threads = 4});
  const auto other = MeasureDemand(BallOnFloor(), OpenUnchanged, {.seed = 8});
  for (int i : {0, 1}) {
    EXPECT_EQ(one[i].share, many[i].share);
    EXPECT_EQ(one[i].sensitivity, many[i].sensitivity);
    EXPECT_NE(one[i].share, other[i].share);
    for (double u = 0.05; u < 1.0; u += 0.1) {
      const auto a = one[i].angles->Draw({u, u, u, u, u}),
                 b = many[i].angles->Draw({u, u, u, u, u});
      EXPECT_EQ(a.theta_h, b.theta_h);
      EXPECT_EQ(a.phi_d, b.phi_d);
    }
  }
}

TEST(Demand, OfASmallerFilmIsAboutTheSame) {
  Scene scene = BallOnFloor();
  const auto all = MeasureDemand(scene, OpenUnchanged, {.paths = 256 * 576});
  scene.film = {240, 240};
  const auto part = MeasureDemand(scene, OpenUnchanged, {.paths = 256 * 576, .max_pixels = 576});
  for (int i : {0, 1}) EXPECT_NEAR(part[i].share, all[i].share, 0.02 * all[i].share);
}

TEST(Demand, NamesWhatCannotBe) {
  EXPECT_EQ(ErrorOf([] { MeasureDemand(BallOnFloor(), OpenUnchanged, {.max_pixels = 0}); }),
            "DemandOptions::max_pixels = 0; must be >= 1");
  Scene scene = BallOnFloor();
  scene.materials[1].source = "builtin:no-such-material";
  EXPECT_THAT(ErrorOf([&] { MeasureDemand(scene, OpenUnchanged); }),
              testing::HasSubstr("materials.white:0.6: "));
}

}  // namespace
}  // namespace pbnbrdf
