// Images whose pixels are known in closed form, and properties that all images have.
#include "pbnbrdf/render/render.h"

#include <atomic>

#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/importance_sampler.h"
#include "pbnbrdf/brdf/scaled.h"
#include "render/render_test_util.h"

namespace pbnbrdf {
namespace {

// Relative errors: of PixelMean's quadrature, and of the image's single precision.
constexpr double kSmooth = 1e-3, kExact = 1e-5;

class EveryEstimator : public testing::TestWithParam<Estimator> {
 protected:
  RenderOptions Options(int samples) const {
    RenderOptions options;
    options.samples_per_pixel = samples;
    options.estimator = GetParam();
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(Render, EveryEstimator,
                         testing::Values(Estimator::kMis, Estimator::kBrdf, Estimator::kLight),
                         [](const auto& test) {
                           return std::string(NameOf(kEstimators, test.param));
                         });

TEST_P(EveryEstimator, AWhiteSphereInAWhiteFurnaceCantBeSeen) {
  Scene scene = SceneFrom(2.0, 25.0, 24);
  AddSphere({0.0, 0.0, 0.0}, 0.5, "white:1", &scene);
  scene.environment = EnvironmentMap::Constant({1.0, 2.0, 3.0});
  const Rendering rendering = RenderTest(scene, Options(64));
  for (int c = 0; c < 3; ++c) {
    ExpectNoiseOnly(
        rendering.image, c, [&](int, int) { return c + 1.0; }, kExact);
  }
}

TEST(Render, NormalsOfAMeshAreInterpolated) {
  Scene scene = SceneFrom(3.0, 20.0, 8);
  AddRectangle({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, "white:0.5", &scene);
  const Vec3 left = Normalized({-0.5, 0.0, 1.0}), right = Normalized({0.7, 0.1, 1.0});
  scene.shapes[0].mesh.mesh.normals = {3.0 * left, right, right, left};
  const Vec3 to_light = Normalized({0.2, 0.1, 1.0}), from = scene.camera.origin;
  scene.directional_lights.push_back({-to_light, {2.0, 2.0, 2.0}});
  const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 64});
  ExpectNoiseOnly(
      rendering.image, 0,
      [&](int x, int y) {
        return PixelMean(scene, x, y, [&](const Vec3& direction) {
          const double at = 0.5 + 0.5 * (from.z / -direction.z) * direction.x;
          const Vec3 normal = Normalized((1.0 - at) * left + at * right);
          return 0.5 / kPi * 2.0 * Dot(normal, to_light);
        });
      },
      kSmooth);
}

// Its value tells in which quadrant of the frame the light is.
class QuadrantBrdf final : public PointwiseBrdf {
 public:
  bool IsIsotropic() const override { return false; }
  std::string Description() const override { return "quadrants"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    const double value = (pair.wi.x > 0.0 ? 0.1 : 0.2) + (pair.wi.y > 0.0 ? 0.0 : 0.04);
    return {value, value, value};
  }
};

TEST(Render, MaterialsAreTurnedAsTheirShapes) {
  const Vec3 to_light = Normalized({0.3, 0.2, 1.0});
  const auto value = [&](const Scene& scene) {
    const auto open = [](const std::string&) {
      return OpenedMaterial{std::make_unique<QuadrantBrdf>()};
    };
    const Rendering rendering = Render(scene, open, {.samples_per_pixel = 1});
    return rendering.image.pixel(1, 1)[0] / to_light.z;
  };
  Scene scene = SceneFrom(3.0, 1.0, 3);
  scene.directional_lights.push_back({-to_light, {1.0, 1.0, 1.0}});
  const auto rectangle = [&](const Vec3& x, const Vec3& y) {
    scene.shapes.clear();
    AddRectangle({0.0, 0.0, 0.0}, x, y, "quadrants", &scene);
    return value(scene);
  };
  EXPECT_NEAR(rectangle({1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 0.10, 1e-6);
  EXPECT_NEAR(rectangle({0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}), 0.14, 1e-6);
  EXPECT_NEAR(rectangle({-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}), 0.24, 1e-6);
  EXPECT_NEAR(rectangle({0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}), 0.20, 1e-6);
  // Seen from behind: x stays, and y, which makes the frame right-handed, turns.
  EXPECT_NEAR(rectangle({-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}), 0.24, 1e-6);
  scene.shapes.clear();
  AddSphere({0.0, 0.0, 0.0}, 1.0, "quadrants", &scene);
  EXPECT_NEAR(value(scene), 0.10, 1e-3);  // the east, about +y, is to the right
  Affine& map = scene.shapes[0].sphere->to_world;
  map = Compose(Affine::Rotation({0.0, 0.0, 1.0}, 90.0), map);
  EXPECT_NEAR(value(scene), 0.14, 1e-3);
}

// In a white furnace a convex body shows its directional albedo.
TEST_P(EveryEstimator, AFurnaceShowsTheDirectionalAlbedo) {
  const Vec3 center = {0.0, 0.0, 0.0};
  for (const char* source :
       {"builtin:rough-iron", "builtin:satin-gold", "builtin:red-satin-plastic"}) {
    SCOPED_TRACE(source);
    Scene scene = SceneFrom(2.0, 16.0, 8);  // all of it sees the sphere, none of it from the side
    AddSphere(center, 0.5, source, &scene);
    scene.environment = EnvironmentMap::Constant({1.0, 1.0, 1.0});
    const Rendering rendering = RenderTest(scene, Options(4000));
    const std::unique_ptr<Brdf> brdf = OpenTestMaterial(source);
    constexpr int kSteps = 64;
    std::vector<double> albedos;  // at equal steps of the cosine
    for (int k = 0; k <= kSteps; ++k) {
      const double cosine = 0.5 + 0.5 * k / kSteps;
      albedos.push_back(DirectionalAlbedo(*brdf, FromSpherical(std::acos(cosine), 0.0))[0]);
    }
    const Vec3 from = scene.camera.origin;
    const auto albedo = [&](const Vec3& direction) {
      const Vec3 normal =
          Normalized(from + DistanceToSphere(from, direction, center, 0.5) * direction - center);
      const double at = (-Dot(normal, direction) - 0.5) * 2.0 * kSteps;
      const auto k = std::min(static_cast<std::size_t>(at), std::size_t{kSteps - 1});
      return albedos[k] + (at - double(k)) * (albedos[k + 1] - albedos[k]);
    };
    ExpectNoiseOnly(
        rendering.image, 0, [&](int x, int y) { return PixelMean(scene, x, y, albedo); }, kSmooth);
  }
}

TEST(Render, EnergyConservingMaterialsAreNeverBrighterThanTheirFurnace) {
  for (const char* source : {"builtin:silver-mirror", "builtin:polished-chromium",
                             "builtin:satin-gold", "builtin:brushed-aluminium"}) {
    SCOPED_TRACE(source);
    Scene scene = SceneFrom(2.0, 25.0, 16);
    AddSphere({0.0, 0.0, 0.0}, 0.5, source, &scene);
    scene.environment = EnvironmentMap::Constant({1.0, 1.0, 1.0});
    const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 64});
    for (int y = 0; y < 16; ++y) {
      for (int c = 0; c < 3; ++c) {
        std::vector<double> row;
        for (int x = 0; x < 16; ++x) row.push_back(rendering.image.pixel(x, y)[c]);
        const MeanAndError mean = MeanOf(row);
        EXPECT_LE(mean.mean, 1.0 + 3.0 * mean.error + kExact) << "row " << y;
      }
    }
  }
}

TEST(Render, PointLight) {
  Scene scene = SceneFrom(3.0, 30.0, 12);
  AddRectangle({0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, "white:0.5", &scene);
  const Vec3 position = {0.5, 0.3, 0.8};
  scene.point_lights.push_back({position, {1.0, 2.0, 4.0}});
  const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 64});
  const Vec3 from = scene.camera.origin;
  const auto radiance = [&](const Vec3& direction) {
    const Vec3 to_light = position - (from + (-from.z / direction.z) * direction);
    const double squared = Dot(to_light, to_light);
    return 0.5 / kPi * (to_light.z / std::sqrt(squared)) / squared;
  };
  for (int c = 0; c < 3; ++c) {
    ExpectNoiseOnly(
        rendering.image, c,
        [&](int x, int y) { return (1 << c) * PixelMean(scene, x, y, radiance); }, kSmooth);
  }
}

TEST(Render, DirectionalLightOnASphere) {
  Scene scene = SceneFrom(2.0, 16.0, 12);
  const Vec3 center = {0.0, 0.0, 0.0}, from = scene.camera.origin;
  AddSphere(center, 0.5, "white:0.8", &scene);
  const Vec3 travels = Normalized({-1.0, -0.5, -0.3});
  scene.directional_lights.push_back({travels, {3.0, 3.0, 3.0}});
  const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 64});
  ExpectNoiseOnly(
      rendering.image, 0,
      [&](int x, int y) {
        return PixelMean(scene, x, y, [&](const Vec3& direction) {
          const double t = DistanceToSphere(from, direction, center, 0.5);
          const Vec3 normal = Normalized(from + t * direction - center);
          return 0.8 / kPi * 3.0 * std::max(0.0, -Dot(normal, travels));
        });
      },
      kSmooth);
}

// Irradiance from a polygon of radiance 1, by Lambert's formula: half the sum, over its edges, of the
// angle that the edge subtends times the cosine between the surface's normal and the normal of the
// plane through the edge and the point.
double PolygonIrradiance(const Vec3& point, const Vec3& normal, const std::vector<Vec3>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = Normalized(corners[i] - point);
    const Vec3 b = Normalized(corners[(i + 1) % corners.size()] - point);
    sum += std::acos(Dot(a, b)) * Dot(Normalized(Cross(a, b)), normal);
  }
  return std::abs(sum) / 2.0;
}

TEST_P(EveryEstimator, RectangleLight) {
  Scene scene = SceneFrom(3.0, 30.0, 10);
  AddRectangle({0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {0.0, 2.0, 0.0}, "white:0.5", &scene);
  // Out of the camera's sight, facing down.
  const RectangleLight light = {{1.2, 0.4, 1.0}, {0.0, 0.5, 0.0}, {0.3, 0.0, 0.1}, {2.0, 2.0, 2.0}};
  scene.rectangle_lights.push_back(light);
  const Rendering rendering = RenderTest(scene, Options(2400));
  const std::vector<Vec3> corners = {
      light.center - light.x_axis - light.y_axis, light.center + light.x_axis - light.y_axis,
      light.center + light.x_axis + light.y_axis, light.center - light.x_axis + light.y_axis};
  const Vec3 from = scene.camera.origin;
  ExpectNoiseOnly(
      rendering.image, 0,
      [&](int x, int y) {
        return PixelMean(scene, x, y, [&](const Vec3& direction) {
          const Vec3 point = from + (-from.z / direction.z) * direction;
          return 0.5 / kPi * 2.0 * PolygonIrradiance(point, {0.0, 0.0, 1.0}, corners);
        });
      },
      kSmooth);
}

TEST(Render, ARectangleLightIsSeenFromItsFrontOnly) {
  for (const double sign : {1.0, -1.0}) {
    Scene scene = SceneFrom(2.0, 20.0, 4);
    scene.rectangle_lights.push_back(
        {{0.0, 0.0, 0.0}, {sign, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 2.0, 3.0}});
    scene.environment = EnvironmentMap::Constant({9.0, 9.0, 9.0});  // hidden
    const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 2, .max_bounces = 0});
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(rendering.image.pixel(1, 2)[c], sign > 0.0 ? float(c + 1) : 0.0f);
    }
  }
}

// Within a sphere every point sees all others equally: E = I / R^2 / (1 - rho).
TEST(Render, LightIsReflectedAsOftenAsAllowed) {
  constexpr double kRho = 0.6, kRadius = 3.0, kIntensity = 5.0;
  Scene scene = SceneFrom(1.0, 60.0, 8);
  AddSphere({0.0, 0.0, 0.0}, kRadius, StrCat("white:", kRho), &scene);
  scene.point_lights.push_back({{0.0, 0.0, 0.0}, {kIntensity, kIntensity, kIntensity}});
  double reflected = 0.0;
  for (const int bounces : {0, 1, 2, 3, 200}) {
    SCOPED_TRACE(bounces);
    const Rendering rendering =
        RenderTest(scene, {.samples_per_pixel = 100, .max_bounces = bounces});
    reflected = kRho * (1.0 - std::pow(kRho, bounces)) / (1.0 - kRho);
    const double expected = reflected * kIntensity / (kRadius * kRadius) / kPi;
    if (bounces == 0) {
      EXPECT_EQ(rendering.image.pixel(3, 3)[0], 0.0f);
    } else {
      ExpectNoiseOnly(
          rendering.image, 1, [&](int, int) { return expected; }, kExact);
    }
  }
}

TEST(Render, EllipsoidsAndMeshesInAFurnace) {
  Scene scene = SceneFrom(4.0, 30.0, 16);
  AddSphere({-0.4, 0.0, 0.0}, 0.5, "white:1", &scene);
  scene.shapes[0].sphere->to_world =
      Compose(Affine::Rotation({1.0, 1.0, 0.0}, 40.0),
              Compose(scene.shapes[0].sphere->to_world, Affine::Scaling({1.5, 0.3, 0.8})));
  AddRectangle({0.5, 0.0, 0.0}, {0.3, 0.0, 0.2}, {0.0, 0.4, 0.1}, "white:1", &scene);
  scene.environment = EnvironmentMap::Constant({1.0, 1.0, 1.0});
  const Rendering rendering = RenderTest(scene, {.samples_per_pixel = 256});
  ExpectNoiseOnly(
      rendering.image, 0, [](int, int) { return 1.0; }, kExact);
}

// With albedos of at most 1, no surface is brighter than the brightest light.
Scene Cove(const std::string& source, int pixels) {
  Scene scene = SceneFrom(3.4, 42.0, pixels);
  AddRectangle({0, -1, 0}, {1, 0, 0}, {0, 0, -1}, source, &scene);
  AddRectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, source, &scene);
  AddRectangle({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, source, &scene);
  AddRectangle({-1, 0, 0}, {0, 0, -1}, {0, 1, 0}, source, &scene);
  AddRectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, source, &scene);
  scene.rectangle_lights.push_back({{0, 0.95, 0}, {0.8, 0, 0}, {0, 0, 0.8}, {1, 1, 1}});
  return scene;
}

std::vector<MeanAndError> Blocks(const Image& image, int size) {
  std::vector<MeanAndError> blocks;
  for (int top = 0; top < image.height; top += size) {
    for (int left = 0; left < image.width; left += size) {
      std::vector<double> values;
      for (int y = top; y < top + size; ++y) {
        for (int x = left; x < left + size; ++x) values.push_back(image.pixel(x, y)[0]);
      }
      blocks.push_back(MeanOf(values));
    }
  }
  return blocks;
}

TEST(Render, ACoveIsNeverBrighterThanItsLight) {
  for (const char* source : {"white:0.99", "builtin:silver-mirror"}) {
    SCOPED_TRACE(source);
    const Rendering rendering =
        RenderTest(Cove(source, 16), {.samples_per_pixel = 64, .max_bounces = 64});
    EXPECT_EQ(rendering.summary.dropped_samples, 0);
    for (const MeanAndError& block : Blocks(rendering.image, 4)) {
      EXPECT_LE(block.mean, 1.0 + 3.0 * block.error + kExact);
    }
  }
}

// The test above would fail for materials that gain energy.
TEST(Render, EnergyGainsExplodeInAClosedRoom) {
  Scene scene = SceneFrom(1.0, 60.0, 4);
  AddSphere({0.0, 0.0, 0.0}, 3.0, "gaining", &scene);
  scene.point_lights.push_back({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
  const auto open = [](const std::string&) {
    return OpenedMaterial{std::make_unique<ScaledBrdf>(OpenTestMaterial("white:1"), 1.2)};
  };
  const Rendering rendering = Render(scene, open, {.samples_per_pixel = 4, .max_bounces = 64});
  const double expected = 1.2 * (std::pow(1.2, 64) - 1.0) / 0.2 / 9.0 / kPi;
  EXPECT_NEAR(rendering.image.pixel(1, 1)[0], expected, 1e-4 * expected);
}

// An environment with a bright spot, a rectangle light and a point light, on glossy and matte
// things.
Scene Still(int pixels) {
  Scene scene = SceneFrom(4.0, 35.0, pixels);
  AddSphere({-0.6, -0.4, 0.0}, 0.6, "builtin:satin-gold", &scene);
  AddSphere({0.7, -0.5, 0.3}, 0.5, "builtin:red-satin-plastic", &scene);
  AddRectangle({0.0, -1.0, 0.0}, {3.0, 0.0, 0.0}, {0.0, 0.0, -3.0}, "white:0.7", &scene);
  Image map(16, 8);
  for (std::size_t i = 0; i < map.rgb.size(); ++i) map.rgb[i] = 0.2f + 0.05f * float(i % 7);
  for (int c = 0; c < 3; ++c) map.pixel(9, 1)[c] = 6.0f - float(c);
  scene.environment = EnvironmentMap(map, 30.0, 0.8);
  scene.rectangle_lights.push_back(
      {{-1.0, 1.2, 0.5}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.5}, {3.0, 2.0, 1.0}});
  scene.point_lights.push_back({{1.0, 1.0, 2.0}, {1.0, 1.0, 2.0}});
  return scene;
}

TEST(Render, EstimatorsDifferInNoiseOnly) {
  const Scene scene = Still(16);
  const auto render = [&](Estimator estimator, int samples, std::uint64_t seed) {
    return RenderTest(scene, {.samples_per_pixel = samples, .seed = seed, .estimator = estimator})
        .image;
  };
  const Image mis = render(Estimator::kMis, 4096, 1);
  for (const Estimator estimator : {Estimator::kBrdf, Estimator::kLight}) {
    SCOPED_TRACE(NameOf(kEstimators, estimator));
    const Image other = render(estimator, 4096, 2);
    for (int c = 0; c < 3; ++c) {
      ExpectNoiseOnly(
          other, c, [&](int x, int y) { return mis.pixel(x, y)[c]; }, kExact);
    }
  }
}

TEST(Render, SameBitsWhateverTheThreads) {
  const Scene scene = Still(40);  // several tiles, not all of them whole
  const auto render = [&](int threads, std::uint64_t seed) {
    return RenderTest(scene, {.samples_per_pixel = 20, .seed = seed, .threads = threads}).image.rgb;
  };
  const std::vector<float> one = render(1, 3);
  EXPECT_EQ(one, render(2, 3));
  EXPECT_NE(one, render(1, 4));
}

// A constant BRDF that counts its evaluations.
struct Asked {
  std::atomic<std::int64_t> calls = 0, values = 0, below = 0;
};
class CountingBrdf final : public Brdf {
 public:
  CountingBrdf(double value, Asked* asked) : value_(value), asked_(asked) {}
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    ++asked_->calls;
    asked_->values += static_cast<std::int64_t>(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      asked_->below += !pairs[i].AboveHorizon();
      values[i] = {value_, value_, value_};
    }
  }
  std::string Description() const override { return "constant"; }

 private:
  double value_;
  Asked* asked_;
};

TEST(Render, AsksMaterialsInBatchesAndForNoMoreThanItNeeds) {
  Scene scene = Still(16);
  scene.materials.push_back({"unseen", "unseen"});
  Asked fitting, asked;
  CountingBrdf brdf(0.2, &fitting);
  const ImportanceSampler sampler(brdf);  // evaluates it, too
  std::vector<std::string> opened;
  const auto open = [&](const std::string& source) {
    opened.push_back(source);
    return OpenedMaterial{std::make_unique<CountingBrdf>(0.2, &asked)};
  };
  const Rendering rendering = Render(scene, open, {.samples_per_pixel = 16});
  EXPECT_THAT(opened, testing::UnorderedElementsAre("builtin:satin-gold",
                                                    "builtin:red-satin-plastic", "white:0.7"));
  const RenderWork& work = rendering.summary.work;
  EXPECT_EQ(work.materials.done, 3);
  EXPECT_EQ(work.materials.Skipped(SkipReason::kUnreferenced), 1);
  EXPECT_EQ(asked.below - 3 * fitting.below, 0);
  EXPECT_EQ(asked.values - 3 * fitting.values, work.brdf_values.done);
  EXPECT_GT(work.brdf_values.done, 16 * 16 * 16);
  const std::int64_t calls = asked.calls - 3 * fitting.calls;
  EXPECT_GE(work.brdf_values.done / calls, 64);
}

TEST(Render, SamplesThatArentFiniteAreDroppedAndCounted) {
  Scene scene = SceneFrom(1.0, 60.0, 4);
  AddSphere({0.0, 0.0, 0.0}, 3.0, "huge", &scene);
  scene.point_lights.push_back({{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
  Asked asked;
  const auto open = [&](const std::string&) {
    return OpenedMaterial{std::make_unique<CountingBrdf>(1e12, &asked)};
  };
  const Rendering rendering = Render(scene, open, {.samples_per_pixel = 3, .max_bounces = 64});
  EXPECT_EQ(rendering.summary.dropped_samples, 4 * 4 * 3);
  EXPECT_EQ(rendering.summary.samples, 0);
  for (float value : rendering.image.rgb) EXPECT_EQ(value, 0.0f);
}

TEST(Render, StopsWhenAsked) {
  int calls = 0;
  const Rendering rendering = RenderTest(
      Still(64), {.samples_per_pixel = 64, .threads = 1, .on_progress = [&](auto& progress) {
                    EXPECT_GT(progress.fraction, 0.0);
                    return ++calls < 20;
                  }});
  EXPECT_TRUE(rendering.summary.stopped);
  EXPECT_EQ(calls, 20);
  EXPECT_GE(rendering.summary.samples, 64 * 64);  // the first pass was finished
  EXPECT_LT(rendering.summary.samples, 64 * 64 * 64);
}

TEST(Render, RefusesOptionsOutOfRangeAndMaterialsThatDontOpen) {
  const Scene scene = Still(4);
  const auto error = [&](const RenderOptions& options) {
    return ErrorOf([&] { RenderTest(scene, options); });
  };
  EXPECT_EQ(error({.samples_per_pixel = 0}),
            "RenderOptions::samples_per_pixel = 0; must be 1 to 16777216");
  EXPECT_EQ(error({.threads = -1}), "RenderOptions::threads = -1; must be >= 0");
  EXPECT_EQ(error({.max_bounces = -1}), "RenderOptions::max_bounces = -1; must be 0 to 100000");
  Scene unknown = SceneFrom(2.0, 30.0, 4);
  AddSphere({0.0, 0.0, 0.0}, 0.5, "builtin:nothing", &unknown);
  EXPECT_THAT(ErrorOf([&] { RenderTest(unknown, {}); }),
              testing::StartsWith("materials.builtin:nothing: builtin:nothing is not one of"));
}

}  // namespace
}  // namespace pbnbrdf
