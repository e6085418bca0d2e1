#include "sources/cie.h"

#include <numeric>

#include "test_util.h"

namespace pbnbrdf {
namespace {

// The fits' own figure: within 2 % or so of the tabulated functions at their peaks. The chromaticity
// of D65, (0.3127, 0.3290), holds all three and the illuminant together.
TEST(Cie, D65IsWhereItShouldBe) {
  double sum[3] = {};
  for (double l = 380.0; l <= 780.0; l += 1.0) {
    const auto xyz = ColorMatching(l);
    for (int c = 0; c < 3; ++c) sum[c] += IlluminantD65(l) * xyz[c];
  }
  const double total = sum[0] + sum[1] + sum[2];
  EXPECT_NEAR(sum[0] / total, 0.3127, 0.001);
  EXPECT_NEAR(sum[1] / total, 0.3290, 0.001);
}

// CIE 1931 2 degree observer, CIE 15:2004, at 450, 550 and 600 nm.
TEST(Cie, ColorMatchingIsNearTheTable) {
  const double table[][4] = {
      {450, 0.3362, 0.0380, 1.7721}, {550, 0.4334, 0.9950, 0.0087}, {600, 1.0622, 0.6310, 0.0008}};
  for (const auto& [l, x, y, z] : table) {
    const auto xyz = ColorMatching(l);
    EXPECT_NEAR(xyz[0], x, 0.02) << l;
    EXPECT_NEAR(xyz[1], y, 0.02) << l;
    EXPECT_NEAR(xyz[2], z, 0.03) << l;
  }
}

std::vector<float> Range(float first, float last, float step) {
  std::vector<float> wavelengths;
  for (float l = first; l <= last; l += step) wavelengths.push_back(l);
  return wavelengths;
}

TEST(Cie, ConstantsAreGreyWhateverTheRange) {
  for (const auto& wavelengths : {Range(400, 700, 20), Range(360, 1000, 3.3f), Range(430, 660, 230),
                                  Range(500, 500, 1), Range(200, 5000, 100)}) {
    Rgb sum = {};
    for (const Rgb& weight : SpectrumToRgb(wavelengths)) {
      for (int c = 0; c < 3; ++c) sum[c] += weight[c];
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], 1.0, 1e-12) << wavelengths.size();
  }
}

TEST(Cie, WavelengthsBeyondAllReasonAreRefused) {
  const auto error = [](float last) {
    return ErrorOf([&] { SpectrumToRgb(std::vector<float>{400, 700, last}); });
  };
  EXPECT_EQ(error(1e5f), "");
  EXPECT_EQ(error(8e32f), "a wavelength of 8e+32 nm; at most 100000");
}

TEST(Cie, BandsHaveTheirColors) {
  const std::vector<float> wavelengths = Range(380, 780, 5);
  const std::vector<Rgb> weights = SpectrumToRgb(wavelengths);
  const auto color = [&](float from, float to) {
    Rgb sum = {};
    for (std::size_t k = 0; k < wavelengths.size(); ++k) {
      if (wavelengths[k] < from || wavelengths[k] > to) continue;
      for (int c = 0; c < 3; ++c) sum[c] += weights[k][c];
    }
    return sum;
  };
  const Rgb blue = color(380, 480), green = color(510, 560), red = color(620, 780);
  EXPECT_GT(blue[2], 3 * std::max(blue[0], blue[1]));
  EXPECT_GT(green[1], 3 * std::max(green[0], green[2]));
  EXPECT_GT(red[0], 3 * std::max(red[1], red[2]));
}

// More wavelengths of the same piecewise linear spectrum change nothing.
TEST(Cie, NodesInBetweenChangeNothing) {
  const std::vector<float> coarse = Range(400, 700, 50), fine = Range(400, 700, 5);
  const std::vector<Rgb> from_coarse = SpectrumToRgb(coarse), from_fine = SpectrumToRgb(fine);
  const std::vector<double> values = {0.1, 0.9, 0.3, 0.2, 0.7, 0.5, 0.4};
  Rgb a = {}, b = {};
  for (int c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < coarse.size(); ++k) a[c] += from_coarse[k][c] * values[k];
    for (std::size_t k = 0; k < fine.size(); ++k) {
      const double x = (fine[k] - 400.0) / 50.0;
      const std::size_t below = std::min<std::size_t>(std::size_t(x), values.size() - 2);
      b[c] += from_fine[k][c] * std::lerp(values[below], values[below + 1], x - double(below));
    }
    EXPECT_NEAR(a[c], b[c], 1e-6);
  }
}

TEST(Cie, TooLittleOfTheRangeIsRefused) {
  EXPECT_THAT(ErrorOf([] { SpectrumToRgb(Range(500, 700, 10)); }),
              testing::HasSubstr("wavelengths of 500 to 700 nm; a colour needs 430 to 660"));
}

TEST(Cie, WhiteIsWhite) {
  const std::vector<double> xyz = {0.9505, 1.0, 1.089};  // D65
  for (double channel : WeightedSum(XyzToRgb(), xyz)) EXPECT_NEAR(channel, 1.0, 1e-3);
}

}  // namespace
}  // namespace pbnbrdf
