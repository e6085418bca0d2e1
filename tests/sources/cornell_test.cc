#include "pbnbrdf/sources/cornell.h"

#include <algorithm>

#include "sources/cie.h"
#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using CornellFiles = ScatteredFiles;

const std::string kHeader = "# a paint\r\n\r\n4 # of them\r\n400 500\r\n600 700\r\n";

// Linear between the wavelengths, under D65, in steps of 0.1 nm: apart from the reader, but for the curves' formulas.
Rgb ColorOf(const std::vector<double>& wavelengths, const std::vector<double>& spectrum) {
  const double to_rgb[3][3] = {
      {3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}};
  Rgb sum = {}, white = {};
  for (std::size_t k = 0; k + 1 < wavelengths.size(); ++k) {
    for (double l = wavelengths[k] + 0.05; l < wavelengths[k + 1]; l += 0.1) {
      const double t = (l - wavelengths[k]) / (wavelengths[k + 1] - wavelengths[k]);
      const double f = (1 - t) * spectrum[k] + t * spectrum[k + 1];
      const auto xyz = ColorMatching(l);
      for (int c = 0; c < 3; ++c) {
        const double w = IlluminantD65(l) *
                         (to_rgb[c][0] * xyz[0] + to_rgb[c][1] * xyz[1] + to_rgb[c][2] * xyz[2]);
        white[c] += w;
        sum[c] += w * f;
      }
    }
  }
  return {sum[0] / white[0], sum[1] / white[1], sum[2] / white[2]};
}

TEST_F(CornellFiles, SpectraBecomeRgb) {
  const auto brdf = Open("a", kHeader + "0.5 0 0.4 3 0.2 0.2\n0.2 0.2\n0.6 0 0.1 2 0.1 0.4 0 0.3");
  EXPECT_TRUE(brdf->IsIsotropic());
  EXPECT_THAT(brdf->Description(), HasSubstr("Cornell measurements at 4 wavelengths"));
  const auto samples = brdf->Measurements();
  ASSERT_EQ(samples.size(), 2u);
  ExpectNear(samples[0].pair.wo, FromSpherical(0.4, 3.0));
  const Rgb wanted = ColorOf({400, 500, 600, 700}, {0.1, 0.4, 0, 0.3});
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(samples[0].value[c], 0.2, 1e-12);
    EXPECT_NEAR(samples[1].value[c], wanted[c], 1e-4);
  }
}

// Zero is the noise floor, and what spectra give below zero stays, too.
TEST_F(CornellFiles, DarkRowsAreKept) {
  const auto samples = Samples("a.brdf", kHeader + "0.5 0 0.4 3 0 0 0 0\n0.6 0 0.1 2 0 1 0 0\n");
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].value, (Rgb{0, 0, 0}));
  EXPECT_LT(samples[1].value[0], 0.0);
}

TEST_F(CornellFiles, BadFilesAreNamed) {
  const auto error = [&](const std::string& text) { return ErrorOfOpening("a.brdf", text); };
  EXPECT_THAT(error("OPTIS\n"),
              HasSubstr("the number of wavelengths: 'OPTIS' is not a whole number"));
  EXPECT_THAT(error("3\n400 500"),
              HasSubstr("a.brdf: ends before all wavelengths; is the file tr"));
  EXPECT_THAT(error("2\n500 400\n"), HasSubstr("line 2: a wavelength of 400 nm; must ascend"));
  EXPECT_THAT(error("2\n400 500\n0 0 0 0 1 1"), HasSubstr("a.brdf: wavelengths of 400 to 500 nm"));
  EXPECT_THAT(error(kHeader + "0.5 0 0.4"), HasSubstr("a.brdf: ends before the angles of a row"));
  EXPECT_THAT(error(kHeader + "0.5 0 0.4 3 1 1 1"), HasSubstr("ends before the spectrum of a row"));
  EXPECT_THAT(error(kHeader + "0.5 0 0.4 3 1 1 x 1"), HasSubstr("line 6, number 7: 'x' is not a"));
  EXPECT_THAT(error(kHeader + "50 0 40 3 1 1 1 1"), HasSubstr("line 6: theta_i is 50 radians"));
}

TEST_F(CornellFiles, MeasuredPaintsAreRead) {
  PBNBRDF_REFERENCE_FILE(folder, "measured/cornell");
  for (const char* name : {"cayman", "krylon_blue", "mystique"}) {
    const auto brdf = OpenBrdf(folder + "/" + name + ".brdf");
    const auto samples = brdf->Measurements();
    EXPECT_EQ(samples.size(), 1439u);
    EXPECT_TRUE(brdf->IsIsotropic());
    // The brightest is at 80 degrees, in the mirror direction within one degree.
    const auto most = std::max_element(samples.begin(), samples.end(),
                                       [](auto& a, auto& b) { return a.value[1] < b.value[1]; });
    EXPECT_NEAR(most->pair.wi.z, std::cos(80 * kPi / 180), 1e-6) << name;
    EXPECT_NEAR(std::acos(most->pair.wo.z), 80 * kPi / 180, kPi / 180) << name;
    EXPECT_NEAR(CosDeltaPhi(most->pair), -1.0, 1e-9);
  }
}

// One row, read by this test itself.
TEST_F(CornellFiles, AMeasuredSpectrumIsTheColorThatItShouldBe) {
  PBNBRDF_REFERENCE_FILE(path, "measured/cornell/krylon_blue.brdf");
  std::ifstream in(path);
  std::vector<double> numbers;
  std::string line, word;
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    while (words >> word) numbers.push_back(std::stod(word));
  }
  ASSERT_EQ(numbers[0], 31.0);
  const std::vector<double> wavelengths(numbers.begin() + 1, numbers.begin() + 32);
  const auto samples = OpenBrdf(path)->Measurements();
  for (std::size_t row : {0u, 700u, 1438u}) {
    const auto begin = numbers.begin() + 32 + static_cast<std::ptrdiff_t>(35 * row);
    ExpectNear(samples[row].pair.wi, FromSpherical(begin[0], begin[1]));
    ExpectNear(samples[row].pair.wo, FromSpherical(begin[2], begin[3]));
    const Rgb wanted = ColorOf(wavelengths, {begin + 4, begin + 35});
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(samples[row].value[c], wanted[c], 1e-3 * std::abs(wanted[c])) << row;
    }
    EXPECT_GT(samples[row].value[2], samples[row].value[0]);  // blue
  }
}

}  // namespace
}  // namespace pbnbrdf
