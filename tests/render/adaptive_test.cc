// Adaptive sampling: RenderOptions::target_error.
#include <cmath>
#include <set>

#include "pixels.h"
#include "render/render_test_util.h"

namespace pbnbrdf {
namespace {

PixelSum PixelOf(const std::vector<double>& grey) {
  PixelSum pixel;
  for (const double value : grey) pixel.Add({value, value, value});
  return pixel;
}

// Of 16 times 1 and 16 times 3 the mean is 2 and its standard error sqrt(32 / 31 / 32).
TEST(Pixels, TheRule) {
  std::vector<double> values;
  for (int i = 0; i < 32; ++i) values.push_back(i % 2 == 0 ? 1.0 : 3.0);
  const PixelSum pixel = PixelOf(values);
  const double error = std::sqrt(1.0 / 31.0);
  EXPECT_NEAR(pixel.StandardError(), error, 1e-12);
  EXPECT_TRUE(IsConverged(pixel, 1.0001 * error / 2.01));
  EXPECT_FALSE(IsConverged(pixel, 0.9999 * error / 2.01));
  values.pop_back();
  EXPECT_FALSE(IsConverged(PixelOf(values), 100.0));  // too few samples
  EXPECT_TRUE(IsConverged(PixelOf(std::vector<double>(32, 0.0)), 1e-9));
  EXPECT_FALSE(IsConverged(PixelOf(std::vector<double>(32, 1e200)), 1.0));  // squares overflow
}

TEST(Pixels, ABlockStaysWholeUntilAllOfItIsConverged) {
  std::vector<PixelSum> pixels(6 * 4, PixelOf(std::vector<double>(40, 1.0)));
  pixels[3 * 6 + 3] = PixelOf({1.0});
  std::vector<PixelBlock> blocks = Cut({0, 0, 6, 4}, kConvergenceBlock);
  EXPECT_EQ(RemoveConverged(pixels, 6, 0.1, &blocks), 8);
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].x, 0);
  pixels[3 * 6 + 3] = pixels[0];
  EXPECT_EQ(RemoveConverged(pixels, 6, 0.1, &blocks), 16);
  EXPECT_TRUE(blocks.empty());
}

// The scene of problems/scenes/sphere.json, with a sky of a few texels.
Scene Sphere(int pixels) {
  Scene scene = SceneFrom(2.2, 30.0, pixels);
  AddSphere({0.0, 0.0, 0.0}, 0.5, "builtin:satin-gold", &scene);
  Image sky(16, 8);
  for (std::size_t i = 0; i < sky.rgb.size(); ++i) {
    sky.rgb[i] = 0.3f + 0.4f * float(i % 5) * float(i < sky.rgb.size() / 2);
  }
  for (int c = 0; c < 3; ++c) sky.pixel(6, 1)[c] = 40.0f;
  scene.environment = EnvironmentMap(sky, 0.0, 1.0);
  return scene;
}

double LuminanceAt(const Image& image, std::size_t pixel) {
  const float* rgb = &image.rgb[3 * pixel];
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

constexpr int kPixels = 24, kMost = 512;
constexpr double kTarget = 0.04;

Rendering RenderAdaptively(double target, int samples, int threads = 0) {
  return RenderTest(
      Sphere(kPixels),
      {.samples_per_pixel = samples, .seed = 2, .threads = threads, .target_error = target});
}

TEST(Adaptive, IsAsExactAsAskedForWithFewerSamples) {
  const Rendering adaptive = RenderAdaptively(kTarget, kMost);
  const Image reference = RenderTest(Sphere(kPixels), {.samples_per_pixel = 4096, .seed = 9}).image;
  const std::int64_t all = std::int64_t(kPixels) * kPixels * kMost;
  EXPECT_LT(adaptive.summary.samples, all / 2);
  const Work& samples = adaptive.summary.work.samples;
  EXPECT_EQ(samples.done, adaptive.summary.samples);
  EXPECT_EQ(samples.done + samples.Skipped(SkipReason::kConverged), all);
  double squares = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < adaptive.samples.size(); ++i) {
    const double mean = LuminanceAt(reference, i);
    const double error =
        std::abs(LuminanceAt(adaptive.image, i) - mean) / (kTarget * (mean + 0.01));
    squares += error * error;
    worst = std::max(worst, error);
  }
  // One standard error is what the rule asks for at most.
  const double rms = std::sqrt(squares / (kPixels * kPixels));
  RecordProperty("rms_over_target", std::to_string(rms));
  RecordProperty("worst_over_target", std::to_string(worst));
  EXPECT_LT(rms, 1.0);
  EXPECT_LT(worst, 5.0);
}

TEST(Adaptive, APixelIsThatOfARenderWithItsSamples) {
  const Rendering adaptive = RenderAdaptively(kTarget, kMost);
  const std::set<std::int64_t> counts(adaptive.samples.begin(), adaptive.samples.end());
  EXPECT_GT(counts.size(), 3u);
  for (const std::int64_t count : counts) {
    EXPECT_TRUE(count == kMost || count % 16 == 1) << count;
    EXPECT_GE(count, 33);
    const Image same = RenderAdaptively(0.0, int(count)).image;
    for (std::size_t i = 0; i < adaptive.samples.size(); ++i) {
      if (adaptive.samples[i] != count) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(adaptive.image.rgb[3 * i + c], same.rgb[3 * i + c]);
      }
    }
  }
}

// The luminance of each single sample, from images of the first 1, 2, ..., count samples.
std::vector<PixelSum> FirstSamples(int count) {
  std::vector<PixelSum> pixels(kPixels * kPixels);
  std::vector<double> sums(pixels.size());
  for (int n = 1; n <= count; ++n) {
    const Image image = RenderAdaptively(0.0, n).image;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double sum = n * LuminanceAt(image, i), value = sum - sums[i];
      pixels[i].Add({value, value, value});
      sums[i] = sum;
    }
  }
  return pixels;
}

TEST(Adaptive, BlocksStopWhereTheRuleSaysSo) {
  const std::vector<PixelSum> pixels = FirstSamples(33);
  constexpr double kLoose = 0.08;
  const std::vector<std::int64_t> samples = RenderAdaptively(kLoose, 64).samples;
  int stopped = 0, going_on = 0;
  for (const PixelBlock& block : Cut({0, 0, kPixels, kPixels}, 4)) {
    double largest = 0.0;  // standard error relative to the limit
    std::set<std::int64_t> counts;
    for (int k = 0; k < 16; ++k) {
      const auto i = std::size_t((block.y + k / 4) * kPixels + block.x + k % 4);
      const double mean = pixels[i].luminance / 33.0;
      largest = std::max(largest, pixels[i].StandardError() / (kLoose * (mean + 0.01)));
      counts.insert(samples[i]);
    }
    EXPECT_EQ(counts.size(), 1u) << "a block stops as one";
    if (std::abs(largest - 1.0) < 1e-3) continue;  // what single precision of the images can't tell
    EXPECT_EQ(*counts.begin() == 33, largest < 1.0) << block.x << ", " << block.y;
    ++(largest < 1.0 ? stopped : going_on);
  }
  EXPECT_GT(stopped, 4);
  EXPECT_GT(going_on, 4);
}

TEST(Adaptive, SameBitsWhateverTheThreads) {
  const Rendering one = RenderAdaptively(kTarget, 128, 1), two = RenderAdaptively(kTarget, 128, 2);
  EXPECT_EQ(one.image.rgb, two.image.rgb);
  EXPECT_EQ(one.samples, two.samples);
}

TEST(Adaptive, ProgressCountsWhatIsSaved) {
  double last = 0.0;
  RenderTest(Sphere(kPixels), {.samples_per_pixel = 256,
                               .target_error = 0.1,
                               .on_progress = [&](const RenderProgress& progress) {
                                 EXPECT_GT(progress.fraction, last);
                                 last = progress.fraction;
                                 return true;
                               }});
  EXPECT_NEAR(last, 1.0, 1e-12);
}

TEST(Adaptive, RefusesTargetsThatAreNone) {
  const auto error = [](double target) {
    return ErrorOf([&] { ValidateRender({.target_error = target}); });
  };
  EXPECT_EQ(error(-0.1), "RenderOptions::target_error = -0.1; must be finite and >= 0");
  EXPECT_EQ(error(NAN), "RenderOptions::target_error = nan; must be finite and >= 0");
}

}  // namespace
}  // namespace pbnbrdf
