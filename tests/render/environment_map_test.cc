// Environment maps: the radiance of each direction, and the density of sampled directions.
#include "pbnbrdf/render/environment_map.h"

#include "test_util.h"

namespace pbnbrdf {
namespace {

Vec3 Direction(double theta, double phi) {
  return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

Image RandomMap(int width, int height, unsigned seed) {
  Image map(width, height);
  const std::vector<double> values = RandomNumbers(map.rgb.size(), 0.0, 3.0, seed);
  for (std::size_t i = 0; i < values.size(); ++i) map.rgb[i] = static_cast<float>(values[i]);
  for (int c = 0; c < 3; ++c) {  // a black texel and a bright one
    map.pixel(2, 1)[c] = 0.0f;
    map.pixel(5, 2)[c] = 80.0f;
  }
  return map;
}

TEST(EnvironmentMap, LooksUpTheTexel) {
  const Image map = RandomMap(8, 4, 1);
  const EnvironmentMap environment(map, 0.0, 2.0);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      for (const double at : {0.01, 0.5, 0.99}) {
        const Rgb radiance =
            environment.Radiance(Direction(kPi * (y + at) / 4.0, 2.0 * kPi * (x + at) / 8.0));
        for (int c = 0; c < 3; ++c) EXPECT_EQ(radiance[c], 2.0f * map.pixel(x, y)[c]);
      }
    }
  }
  // The middle is +z, a quarter from the left +x, the top +y.
  EXPECT_EQ(environment.Radiance({1e-9, 1e-9, 1.0})[0], 2.0f * map.pixel(3, 1)[0]);
  EXPECT_EQ(environment.Radiance({1.0, -1e-9, 1e-9})[0], 2.0f * map.pixel(2, 2)[0]);
  for (const double y : {1.0, -1.0, 1.0 + 1e-15}) {
    EXPECT_TRUE(std::isfinite(environment.Radiance({0.0, y, 0.0})[0]));
  }
}

TEST(EnvironmentMap, TurnsAboutTheUpAxis) {
  const Image map = RandomMap(8, 4, 2);
  const EnvironmentMap still(map, 0.0, 1.0), turned(map, 90.0, 1.0);
  // Right-handed about +y, z goes to x and x to -z.
  EXPECT_EQ(still.Radiance({0.1, 0.2, 1.0}), turned.Radiance({1.0, 0.2, -0.1}));
  EXPECT_EQ(still.Pdf({0.1, 0.2, 1.0}), turned.Pdf({1.0, 0.2, -0.1}));
  double pdf;
  Rgb radiance;
  for (int i = 0; i < 100; ++i) {
    const Vec3 direction = turned.Sample({(i + 0.5) / 100.0, 0.37}, &pdf, &radiance);
    EXPECT_EQ(turned.Radiance(direction), radiance);
    EXPECT_EQ(turned.Pdf(direction), pdf);
  }
}

// By quadrature on a fine grid of directions.
TEST(EnvironmentMap, DensityIntegratesToOne) {
  const EnvironmentMap environment(RandomMap(8, 4, 3), 20.0, 1.5);
  constexpr int kTheta = 400, kPhi = 720;
  double integral = 0.0;
  for (int i = 0; i < kTheta; ++i) {
    const double low = kPi * i / kTheta, high = kPi * (i + 1) / kTheta;
    const double solid = (std::cos(low) - std::cos(high)) * 2.0 * kPi / kPhi;
    for (int j = 0; j < kPhi; ++j) {
      integral +=
          solid * environment.Pdf(Direction((low + high) / 2.0, 2.0 * kPi * (j + 0.5) / kPhi));
    }
  }
  EXPECT_NEAR(integral, 1.0, 1e-9);
}

// Counts in cells against the integral of the density: chi-square, 49 degrees of freedom and fewer.
TEST(EnvironmentMap, DrawsWithItsDensity) {
  const EnvironmentMap environment(RandomMap(8, 4, 4), 45.0, 1.0);
  constexpr int kDown = 5, kAcross = 10, kSamples = 200000, kFine = 64;
  std::vector<double> counts(kDown * kAcross), expected(kDown * kAcross);
  const std::vector<double> u = RandomNumbers(2 * kSamples, 0.0, 1.0, 5);
  const auto cell_of = [&](const Vec3& d) {
    const double v = (1.0 - d.y) / 2.0, phi = std::atan2(d.x, -d.z) / (2.0 * kPi);
    const int down = std::min(int(v * kDown), kDown - 1);
    return down * kAcross + std::min(int((phi - std::floor(phi)) * kAcross), kAcross - 1);
  };
  for (int i = 0; i < kSamples; ++i) {
    double pdf;
    Rgb radiance;
    const Vec3 d = environment.Sample({u[2 * i], u[2 * i + 1]}, &pdf, &radiance);
    EXPECT_NEAR(Length(d), 1.0, 1e-12);
    EXPECT_GT(pdf, 0.0);
    ++counts[cell_of(d)];
  }
  const double solid = 4.0 * kPi / (kDown * kAcross * kFine * kFine);
  for (int i = 0; i < kDown * kFine; ++i) {
    for (int j = 0; j < kAcross * kFine; ++j) {
      const Vec3 d = Direction(std::acos(1.0 - 2.0 * (i + 0.5) / (kDown * kFine)),
                               2.0 * kPi * (j + 0.5) / (kAcross * kFine));
      expected[cell_of(d)] += kSamples * solid * environment.Pdf(d);
    }
  }
  double chi_square = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 5.0) continue;
    chi_square += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  EXPECT_LT(chi_square, 85.4);  // exceeded once in 1000 times
}

TEST(EnvironmentMap, NegativeIsBlackAndNotFiniteIsRefused) {
  Image map(3, 2);
  map.pixel(1, 0)[2] = -4.0f;
  EXPECT_TRUE(EnvironmentMap(map, 0.0, 1.0).IsBlack());
  EXPECT_EQ(EnvironmentMap(map, 0.0, 1.0).Pdf({1.0, 0.0, 0.0}), 0.0);
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    map.pixel(2, 1)[0] = value;
    EXPECT_THAT(ErrorOf([&] { EnvironmentMap(map, 0.0, 1.0); }),
                testing::StartsWith("texel (2, 1) is "));
  }
  map.pixel(2, 1)[0] = 1e30f;
  EXPECT_THAT(ErrorOf([&] { EnvironmentMap(map, 0.0, 1e30); }), testing::HasSubstr("scaled inf"));
}

}  // namespace
}  // namespace pbnbrdf
