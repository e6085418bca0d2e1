// Skipping work leaves the image the same, bit for bit, and is counted.
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <random>
#include <set>
#include <thread>

#include "base/parallel.h"
#include "pbnbrdf/models/analytic.h"
#include "render/render_test_util.h"

namespace pbnbrdf {
namespace {

constexpr std::array kKinds = {&RenderWork::materials, &RenderWork::samples,
                               &RenderWork::path_vertices, &RenderWork::rays,
                               &RenderWork::brdf_values};
constexpr std::array kEveryEstimator = {Estimator::kMis, Estimator::kBrdf, Estimator::kLight};

// Gives a proposal: fitting one takes longer than these renders.
OpenedMaterial OpenQuickly(const std::string& source) {
  static const Proposal proposal = FitProposal(GgxBrdf({0.5, 0.5, 0.5}, 0.3));
  return {OpenTestMaterial(source), proposal};
}

// Expects the same image with skip and without, and counts that agree. Returns the work with skip.
RenderWork ExpectSameWithoutSkip(const Scene& scene, RenderOptions options) {
  const Rendering with = Render(scene, OpenQuickly, options);
  options.skip = false;
  const Rendering without = Render(scene, OpenQuickly, options);
  EXPECT_EQ(with.image.rgb, without.image.rgb);
  EXPECT_EQ(with.samples, without.samples);
  EXPECT_EQ(with.summary.dropped_samples, without.summary.dropped_samples);
  for (const auto kind : kKinds) {
    const Work& most = without.summary.work.*kind;
    const Work& least = with.summary.work.*kind;
    EXPECT_EQ(least.needed, most.needed);
    EXPECT_EQ(least.done, least.needed);
    const bool either_way = kind == &RenderWork::path_vertices || kind == &RenderWork::samples;
    EXPECT_EQ(most.done, least.done + (either_way ? 0 : least.AllSkipped()));
    EXPECT_EQ(most.AllSkipped(), either_way ? least.AllSkipped() : 0);
  }
  return with.summary.work;
}

TEST(Skip, ShippedScenesKeepTheirBits) {
  for (const char* name : {"sphere", "furnace", "cove", "gallery", "one_of_many"}) {
    SCOPED_TRACE(name);
    Scene scene = ReadScene(StrCat(PBNBRDF_PROBLEMS, "/scenes/", name, ".json"));
    scene.film = {40, 36};
    for (const Estimator estimator : kEveryEstimator) {
      const RenderWork work =
          ExpectSameWithoutSkip(scene, {.samples_per_pixel = 6, .estimator = estimator});
      EXPECT_GT(work.rays.done, 0);
    }
  }
}

class RandomScenes {
 public:
  explicit RandomScenes(unsigned seed) : random_(seed) {}

  // Shapes in front of the camera, or all around it, an environment half black, and lights.
  Scene Next() {
    Scene scene;
    const Vec3 from = Uniform(0.3) < 0.1 ? 1000.0 * Point() : Point();
    const Vec3 ahead = Normalized(Point());
    scene.camera = {from, from + ahead, {0.1, 1.0, 0.2}, 20.0 + Uniform(100.0)};
    const Vec3 middle = Uniform(1.0) < 0.5 ? from : from + 6.0 * ahead;
    const auto place = [&] { return middle + (Uniform(1.0) < 0.5 ? 2.0 : 0.7) * Point(); };
    scene.film = {35 + int(Uniform(30.0)), 35 + int(Uniform(30.0))};
    for (int i = 0; i < 3; ++i) {
      const Vec3 center = place();
      AddSphere(center, 0.1 + Uniform(0.4), "builtin:satin-gold", &scene);
      Affine& map = scene.shapes.back().sphere->to_world;
      map = Compose(map, Compose(Affine::Rotation(Point(), 100.0 * Uniform(1.0)),
                                 Affine::Scaling({1.0, 0.2 + Uniform(1.0), 2.0})));
      AddRectangle(place(), 0.4 * Point(), 0.4 * Point(), "white:0.6", &scene);
    }
    Image map(8, 4);
    for (float& value : map.rgb) value = Uniform(1.0) < 0.5 ? 0.0f : float(Uniform(3.0));
    scene.environment = EnvironmentMap(map, 20.0, 1.0);
    scene.rectangle_lights.push_back({place(), 0.3 * Point(), 0.3 * Point(), {3.0, 2.0, 1.0}});
    scene.point_lights.push_back({place(), {1.0, 1.0, 2.0}});
    scene.directional_lights.push_back({Normalized(Point()), {1.0, 0.5, 1.0}});
    scene.materials.push_back({"unused", "white:0.2"});
    return scene;
  }

 private:
  double Uniform(double most) { return std::uniform_real_distribution(0.0, most)(random_); }
  Vec3 Point() {
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_);
    return {x, y, normal(random_)};
  }

  std::mt19937 random_;
};

TEST(Skip, RandomScenesKeepTheirBitsAndSkipForEveryReason) {
  RandomScenes scenes(7);
  RenderWork all;
  for (int i = 0; i < 24; ++i) {
    SCOPED_TRACE(i);
    const RenderOptions options = {.samples_per_pixel = 5,
                                   .seed = std::uint64_t(i),
                                   .max_bounces = i % 3 == 0 ? 64 : i % 3,
                                   .estimator = kEveryEstimator[std::size_t(i % 3)]};
    all += ExpectSameWithoutSkip(scenes.Next(), options);
  }
  EXPECT_EQ(all.materials.Skipped(SkipReason::kUnreferenced), 24);
  EXPECT_GT(all.materials.Skipped(SkipReason::kNotReached), 0);
  EXPECT_GT(all.rays.Skipped(SkipReason::kBelowHorizon), 0);
  EXPECT_GT(all.rays.Skipped(SkipReason::kUnlit), 0);
  EXPECT_GT(all.rays.Skipped(SkipReason::kEmptyTiles), 0);
  EXPECT_GT(all.brdf_values.Skipped(SkipReason::kBelowHorizon), 0);
  EXPECT_GT(all.brdf_values.Skipped(SkipReason::kOccluded), 0);
  EXPECT_GT(all.brdf_values.Skipped(SkipReason::kUnlit), 0);
  EXPECT_GT(all.path_vertices.Skipped(SkipReason::kEnded), 0);
}

TEST(Skip, PathsToNothingAskForNothing) {
  Scene scene = SceneFrom(2.0, 16.0, 16);  // all of it sees the sphere
  AddSphere({0.0, 0.0, 0.0}, 0.5, "white:0.5", &scene);
  const std::int64_t paths = 16 * 16 * 4;
  const RenderOptions options = {.samples_per_pixel = 4};
  const RenderWork dark = RenderTest(scene, options).summary.work;  // no light at all
  EXPECT_EQ(dark.brdf_values.done, 0);
  EXPECT_EQ(dark.brdf_values.Skipped(SkipReason::kUnlit), paths);
  EXPECT_EQ(dark.rays.done, 2 * paths);
  EXPECT_EQ(dark.path_vertices.done, 2 * paths);
  scene.directional_lights.push_back({{0.0, 0.0, 1.0}, {1.0, 1.0, 1.0}});  // from behind
  const RenderWork behind = RenderTest(scene, options).summary.work;
  EXPECT_EQ(behind.brdf_values.done, 0);
  EXPECT_EQ(behind.brdf_values.Skipped(SkipReason::kBelowHorizon), paths);
  EXPECT_EQ(behind.rays.Skipped(SkipReason::kBelowHorizon), paths);
}

TEST(Skip, SavedSecondsAreThoseOfTheMean) {
  Work work;
  EXPECT_EQ(work.SecondsSavedEstimate(), 0.0);
  work.Skipped(SkipReason::kUnlit) = 6;
  EXPECT_EQ(work.SecondsSavedEstimate(), std::nullopt);
  work.Skipped(SkipReason::kOccluded) = 2;
  work.done = 4;
  work.seconds = 3.0;
  EXPECT_EQ(work.SecondsSavedEstimate(), 6.0);
}

// Spheres side by side, too small to be seen from one another; the last is behind the camera.
Scene Row(int count) {
  Scene scene = SceneFrom(10.0, 40.0, 48);
  for (int i = 0; i < count; ++i) {
    const bool last = i + 1 == count;
    AddSphere({last ? 0.0 : 1.5 * i - 2.0, 0.0, last ? 20.0 : 0.0}, 0.5, StrCat("white:0.", i + 1),
              &scene);
  }
  scene.directional_lights.push_back({{0.0, 0.0, -1.0}, {1.0, 1.0, 1.0}});
  return scene;
}

TEST(Skip, MaterialsAreOpenedOnceAndOnlyIfAPathGetsThere) {
  for (const bool skip : {true, false}) {
    std::multiset<std::string> opened;
    const auto open = [&](const std::string& source) {
      opened.insert(source);
      return OpenQuickly(source);
    };
    const RenderOptions options = {.samples_per_pixel = 2, .max_bounces = 1, .skip = skip};
    const Work work = Render(Row(4), open, options).summary.work.materials;
    std::multiset<std::string> expected = {"white:0.1", "white:0.2", "white:0.3"};
    EXPECT_EQ(work.needed, 3);
    EXPECT_EQ(work.Skipped(SkipReason::kNotReached), skip ? 1 : 0);
    if (!skip) expected.insert("white:0.4");
    EXPECT_EQ(opened, expected);
  }
}

TEST(Skip, TheFirstMaterialThatFailsIsNamedWhateverTheThreads) {
  for (const int threads : {1, 2}) {
    for (int repeat = 0; repeat < 10; ++repeat) {
      const auto open = [](const std::string& source) {
        if (source != "white:0.1") Fail("can't open ", source);
        return OpenQuickly(source);
      };
      const auto error = [&](const Scene& scene) {
        return ErrorOf([&] { Render(scene, open, {.samples_per_pixel = 2, .threads = threads}); });
      };
      EXPECT_EQ(error(Row(4)), "materials.white:0.2: can't open white:0.2");
    }
  }
}

TEST(Skip, AMaterialOutOfSightMayBeMissing) {
  const auto open = [](const std::string& source) {
    if (source == "white:0.3") Fail("missing");
    return OpenQuickly(source);
  };
  const RenderOptions options = {.samples_per_pixel = 2, .max_bounces = 1};
  EXPECT_EQ(Render(Row(3), open, options).summary.work.materials.done, 2);
  RenderOptions all = options;
  all.skip = false;
  EXPECT_EQ(ErrorOf([&] { Render(Row(3), open, all); }), "materials.white:0.3: missing");
}

// A thread that waits for an opener's tasks must not start a tile, which would wait for the opener.
// There are more threads than cores, so that both happen at the same time.
TEST(Skip, OpenersMayWorkInParallel) {
  constexpr int kThreads = 8;
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, kThreads);
  const auto open = [](const std::string& source) {
    std::atomic<int> tasks = 0;
    ParallelFor(64, [&](std::size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      ++tasks;
    });
    EXPECT_EQ(tasks, 64);
    return OpenQuickly(source);
  };
  Scene scene = Row(6);
  scene.film = {256, 256};
  tbb::task_arena arena(kThreads);
  for (int repeat = 0; repeat < 10; ++repeat) {
    const auto render = [&] {
      return Render(scene, open, {.samples_per_pixel = 1, .max_bounces = 1});
    };
    EXPECT_EQ(arena.execute(render).summary.work.materials.done, 5);
  }
}

TEST(Skip, AProposalGivenIsUsed) {
  Scene scene = SceneFrom(2.0, 16.0, 8);
  AddSphere({0.0, 0.0, 0.0}, 0.5, "a material", &scene);
  Image map(2, 1);
  map.rgb = {1, 2, 3, 4, 5, 6};
  scene.environment = EnvironmentMap(map, 0.0, 1.0);
  const auto render = [&](double rho, const std::optional<Proposal>& proposal) {
    const auto open = [&](const std::string&) {
      return OpenedMaterial{OpenTestMaterial(StrCat("white:", rho)), proposal};
    };
    return Render(scene, open, {.samples_per_pixel = 8}).image.rgb;
  };
  const Proposal narrow = FitProposal(GgxBrdf({0.5, 0.5, 0.5}, 0.1));
  std::vector<float> half = render(0.25, narrow);
  for (float& value : half) value *= 2.0f;
  EXPECT_EQ(render(0.5, narrow), half);  // the very same paths
  EXPECT_NE(render(0.5, std::nullopt), half);
}

}  // namespace
}  // namespace pbnbrdf
