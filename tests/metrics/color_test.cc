#include "pbnbrdf/metrics/color.h"

#include <limits>

#include "test_util.h"

namespace pbnbrdf {
namespace {

// Sharma, Wu and Dalal 2005, table 1. They chose them so that each usual mistake shows.
struct PublishedPair {
  Lab x, y;
  double delta_e;
};
constexpr PublishedPair kPublished[] = {
    {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
    {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
    {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
    {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
    {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
    {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
    {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
    {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
    {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
    {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
    {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
    {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
    {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
    {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
    {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
    {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
    {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
    {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
    {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
    {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

void ExpectLab(const Rgb& linear, const Lab& expected, double tolerance) {
  const Lab lab = ToLab(linear);
  EXPECT_NEAR(lab.l, expected.l, tolerance);
  EXPECT_NEAR(lab.a, expected.a, tolerance);
  EXPECT_NEAR(lab.b, expected.b, tolerance);
}

TEST(FromXyz, IsTheInverseOfToXyz) {
  for (const Rgb& linear : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{0.3, 20.0, -0.7}}) {
    const Rgb back = FromXyz(ToXyz(linear));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], linear[c], 1e-13);
  }
}

TEST(ToXyz, PrimariesAndWhiteHaveTheirChromaticities) {
  const std::pair<Rgb, std::pair<double, double>> kCases[] = {{{1, 0, 0}, {0.64, 0.33}},
                                                              {{0, 1, 0}, {0.30, 0.60}},
                                                              {{0, 0, 1}, {0.15, 0.06}},
                                                              {{1, 1, 1}, {0.3127, 0.3290}}};
  for (const auto& [rgb, expected] : kCases) {
    const auto [x, y, z] = ToXyz(rgb);
    EXPECT_NEAR(x / (x + y + z), expected.first, 1e-12);
    EXPECT_NEAR(y / (x + y + z), expected.second, 1e-12);
  }
  EXPECT_NEAR(ToXyz({1, 1, 1})[1], 1.0, 1e-15);
}

// To the digits of common tables, whose white points are rounded.
TEST(ToLab, OfThePrimaries) {
  ExpectLab({1, 0, 0}, {53.24, 80.09, 67.20}, 0.03);
  ExpectLab({0, 1, 0}, {87.73, -86.18, 83.18}, 0.03);
  ExpectLab({0, 0, 1}, {32.30, 79.19, -107.86}, 0.03);
}

TEST(ToLab, GreysAreNeutral) {
  ExpectLab({0, 0, 0}, {0, 0, 0}, 1e-12);
  ExpectLab({1, 1, 1}, {100, 0, 0}, 1e-12);
  // The cube root of 0.18 is 0.564622; below (6/29)^3 the lightness is linear, 903.2963 Y.
  ExpectLab({0.18, 0.18, 0.18}, {116 * 0.5646216173 - 16, 0, 0}, 1e-7);
  ExpectLab({0.004, 0.004, 0.004}, {0.004 * 24389.0 / 27.0, 0, 0}, 1e-12);
}

TEST(ToLab, IsFiniteForAllThatIsFinite) {
  for (double value : {0.0, std::numeric_limits<double>::denorm_min(), 1e-30, 5.0, 1e12,
                       std::numeric_limits<double>::max()}) {
    for (const Rgb& rgb : {Rgb{value, value, value}, Rgb{value, 0, 0}, Rgb{0, 0, value}}) {
      const Lab lab = ToLab(rgb);
      EXPECT_TRUE(std::isfinite(lab.l) && std::isfinite(lab.a) && std::isfinite(lab.b)) << value;
      EXPECT_TRUE(std::isfinite(DeltaE2000(lab, ToLab({0.1, 0.2, 0.3})))) << value;
    }
  }
}

TEST(DeltaE2000, AgreesWithThePublishedPairs) {
  for (const auto& [x, y, delta_e] : kPublished) {
    // Half of the last digit printed, and that of the Lab values themselves.
    EXPECT_NEAR(DeltaE2000(x, y), delta_e, 1e-4) << x.a << " " << x.b << ", " << y.a << " " << y.b;
  }
}

TEST(DeltaE2000, IsSymmetricAndZeroForEqualColours) {
  const std::vector<double> numbers = RandomNumbers(6000, 0.0, 1.0, /*seed=*/5);
  for (std::size_t i = 0; i + 6 <= numbers.size(); i += 6) {
    const Lab x = {100 * numbers[i], 200 * numbers[i + 1] - 100, 200 * numbers[i + 2] - 100};
    const Lab y = {100 * numbers[i + 3], 200 * numbers[i + 4] - 100, 200 * numbers[i + 5] - 100};
    EXPECT_EQ(DeltaE2000(x, y), DeltaE2000(y, x));
    EXPECT_GT(DeltaE2000(x, y), 0.0);
    EXPECT_EQ(DeltaE2000(x, x), 0.0);
  }
  for (const auto& [x, y, delta_e] : kPublished) EXPECT_EQ(DeltaE2000(x, y), DeltaE2000(y, x));
}

// Between greys only lightness counts: dL / S_L, S_L = 1 + 0.015 * 100 / sqrt(120) at L = 60.
TEST(DeltaE2000, OfGreysIsThatOfTheirLightness) {
  EXPECT_NEAR(DeltaE2000({58, 0, 0}, {62, 0, 0}), 4 / (1 + 1.5 / std::sqrt(120.0)), 1e-12);
}

TEST(HueChromaDifference, LeavesLightnessOut) {
  EXPECT_EQ(HueChromaDifference({10, 1, 2}, {90, 4, 6}), 5.0);
}

}  // namespace
}  // namespace pbnbrdf
