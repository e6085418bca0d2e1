// FLIP: exact values on constant images, bounds, borders, and the exposures of HDR-FLIP.
#include "pbnbrdf/metrics/flip.h"

#include <algorithm>

#include "image/images.h"
#include "pbnbrdf/metrics/color.h"

namespace pbnbrdf {
namespace {

TEST(Flip, LargestBetweenGreenAndBlue) {
  // Constant images have no edges, and their filtered colours are their own: the error is that of
  // the colours, 1 for green and blue, which are furthest apart.
  const Image green = ConstantImage(20, 15, 0, 1, 0), blue = ConstantImage(20, 15, 0, 0, 1);
  for (double value : FlipMap(green, blue)) EXPECT_NEAR(value, 1.0, 1e-9);
}

TEST(Flip, OfTwoGreysByHand) {
  // |L - L'|^0.7 below 0.4 of its largest value, scaled so that this is 0.95.
  const Image x = ConstantImage(12, 12, 0.5f, 0.5f, 0.5f),
              y = ConstantImage(12, 12, 0.4f, 0.4f, 0.4f);
  const auto hunt = [](const Rgb& linear) {
    Lab lab = ToLab(linear);
    lab.a *= 0.01 * lab.l, lab.b *= 0.01 * lab.l;
    return lab;
  };
  const Lab green = hunt({0, 1, 0}), blue = hunt({0, 0, 1});
  const double most = std::abs(green.l - blue.l) + std::hypot(green.a - blue.a, green.b - blue.b);
  const double lightness = 116.0 * (std::cbrt(double(0.5f)) - std::cbrt(double(0.4f)));
  const double expected = 0.95 / 0.4 * std::pow(lightness / most, 0.7);
  for (double value : FlipMap(x, y)) EXPECT_NEAR(value, expected, 1e-6);
}

TEST(Flip, FindsThePixelThatDiffers) {
  const Image x = ConstantImage(64, 48, 0.2f, 0.2f, 0.2f);
  Image y = x;
  std::fill_n(y.pixel(40, 10), 3, 1.0f);
  const std::vector<double> map = FlipMap(x, y);
  const auto largest = std::max_element(map.begin(), map.end());
  EXPECT_EQ(largest - map.begin(), 10 * 64 + 40);
  EXPECT_NEAR(map[40 * 64 + 5], 0.0, 1e-9);  // beyond every filter's reach
}

TEST(Flip, MirroredImagesMirrorTheMap) {
  const Image x = RandomImage(33, 21, 0.0, 1.0, 1), y = RandomImage(33, 21, 0.0, 1.0, 2);
  const auto transposed = [](const Image& image) {
    Image turned(image.height, image.width);
    for (int row = 0; row < image.height; ++row) {
      for (int column = 0; column < image.width; ++column) {
        std::copy_n(image.pixel(column, row), 3, turned.pixel(row, column));
      }
    }
    return turned;
  };
  const std::vector<double> map = FlipMap(x, y), turned = FlipMap(transposed(x), transposed(y));
  for (int row = 0; row < 21; ++row) {
    for (int column = 0; column < 33; ++column) {
      ASSERT_NEAR(map[std::size_t(row * 33 + column)], turned[std::size_t(column * 21 + row)],
                  1e-9);
    }
  }
}

TEST(Flip, BetweenZeroAndOne) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    Image x = RandomImage(30, 30, -2.0, 3.0, seed), y = RandomImage(30, 30, -2.0, 3.0, seed + 10);
    for (double value : FlipMap(x, y)) ASSERT_TRUE(value >= 0.0 && value <= 1.0 + 1e-12) << value;
  }
}

// The ACES curve as [2] takes it.
double ToneCurve(double x) {
  x *= 0.6;
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

TEST(HdrFlip, ExposuresShowBrightestAndMedianAlike) {
  Image image(10, 10);  // greys 1, ..., 100
  for (int i = 0; i < 100; ++i) std::fill_n(image.pixel(i % 10, i / 10), 3, float(i + 1));
  const FlipExposures exposures = ReferenceExposures(image);
  EXPECT_NEAR(ToneCurve(std::exp2(exposures.first) * 100.0), 0.85, 1e-9);
  EXPECT_NEAR(ToneCurve(std::exp2(exposures.last) * 50.5), 0.85, 1e-9);
  EXPECT_EQ(exposures.count, 2);
  std::fill_n(image.pixel(0, 0), 3, 5000.0f);
  EXPECT_EQ(ReferenceExposures(image).count, 7);  // log2(5000 / 51.5) = 6.6, rounded up
}

TEST(HdrFlip, ExposuresOfImagesThatAreMostlyBlack) {
  Image image(10, 10);
  EXPECT_EQ(ReferenceExposures(image).first, 0.0);
  EXPECT_EQ(ReferenceExposures(image).last, 0.0);
  for (int i = 0; i < 4; ++i) std::fill_n(image.pixel(i, 0), 3, float(1 << (2 * i)));
  const FlipExposures exposures = ReferenceExposures(image);
  EXPECT_NEAR(ToneCurve(std::exp2(exposures.first) * 64.0), 0.85, 1e-9);
  EXPECT_NEAR(ToneCurve(std::exp2(exposures.last) * 0x1p-23), 0.85, 1e-9);
  for (float& value : image.rgb) value -= 100.0f;
  EXPECT_EQ(ReferenceExposures(image).first, 0.0);
}

TEST(HdrFlip, NegativeValuesAreShownByTheCurve) {
  const auto hdr_flip = [](float value) {
    Image x = ConstantImage(20, 20, 1.0f, 1.0f, 1.0f), y = x;
    std::fill_n(y.pixel(10, 10), 3, value);
    return HdrFlipMap(x, y)[10 * 20 + 10];
  };
  EXPECT_EQ(hdr_flip(-100.0f), hdr_flip(1000.0f));  // both white
  EXPECT_EQ(hdr_flip(-0.005f), hdr_flip(0.0f));     // both black
}

TEST(HdrFlip, SeesHighlightsThatOneExposureCuts) {
  Image x = ConstantImage(32, 32, 0.5f, 0.5f, 0.5f), y = x;
  std::fill_n(x.pixel(16, 16), 3, 50.0f);
  std::fill_n(y.pixel(16, 16), 3, 400.0f);
  const std::vector<double> flip = FlipMap(x, y), hdr_flip = HdrFlipMap(x, y);
  EXPECT_EQ(flip[16 * 32 + 16], 0.0);
  EXPECT_GT(hdr_flip[16 * 32 + 16], 0.05);
}

}  // namespace
}  // namespace pbnbrdf
