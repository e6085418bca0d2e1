#include "pbnbrdf/sources/zemax.h"

#include <algorithm>

#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using ZemaxFiles = ScatteredFiles;

struct Grid {
  std::string symmetry = "PlaneSymmetrical", content = "Monochrome", type = "BRDF";
  std::vector<int> rotations = {0}, incidences = {20, 50}, azimuths = {0, 60, 180},
                   radials = {0, 10, 30};
};

// A channel's value: tells all four indices apart.
double ValueAt(std::size_t c, std::size_t s, std::size_t i, std::size_t a, std::size_t r) {
  return 0.1 + 0.07 * double(c) + 0.2 * double(s) + 0.05 * double(i) + 0.01 * double(a) +
         0.001 * double(r);
}

std::string ListOf(const std::string& keyword, const std::vector<int>& angles) {
  std::string text = StrCat(keyword, "  ", angles.size(), "\n");
  for (int angle : angles) text += StrCat(angle, "\t");
  return text + "\n";
}

std::string TextOf(const Grid& g) {
  std::string text =
      "# a test\nSource\tMeasured\nSymmetry " + g.symmetry + "\nSpectralContent  " + g.content +
      "\nScatterType  " + g.type + "\n" + ListOf("SampleRotation", g.rotations) +
      ListOf("AngleOfIncidence", g.incidences) + ListOf("ScatterAzimuth", g.azimuths) +
      ListOf("ScatterRadial", g.radials) + "\n";
  const std::vector<std::string> channels =
      g.content == "XYZ" ? std::vector<std::string>{"TristimulusX", "TristimulusY", "TristimulusZ"}
                         : std::vector<std::string>{"Monochrome"};
  for (std::size_t c = 0; c < channels.size(); ++c) {
    text += channels[c] + "\nDataBegin\n";
    for (std::size_t s = 0; s < g.rotations.size(); ++s) {
      for (std::size_t i = 0; i < g.incidences.size(); ++i) {
        text += "TIS 0.5\n";
        for (std::size_t a = 0; a < g.azimuths.size(); ++a) {
          for (std::size_t r = 0; r < g.radials.size(); ++r) {
            text += StrCat(r == 0 ? ValueAt(c, s, i, 0, 0) : ValueAt(c, s, i, a, r), "\t");
          }
          text += "\n";
        }
      }
    }
    text += "DataEnd\n";
  }
  return text;
}

// The direction by spherical trigonometry: the triangle of the normal, the specular direction and wo.
void ExpectAt(const DirectionPair& pair, double incidence, double azimuth, double radial) {
  const double d = kPi / 180, i = incidence * d, a = azimuth * d, r = radial * d;
  const double cos_o = std::cos(i) * std::cos(r) + std::sin(i) * std::sin(r) * std::cos(a);
  EXPECT_NEAR(pair.wi.z, std::cos(i), 1e-12);
  EXPECT_NEAR(pair.wo.z, cos_o, 1e-12);
  if (i == 0.0 || cos_o > 1.0 - 1e-12) return;
  const double from_specular =
      (std::cos(r) - std::cos(i) * cos_o) / (std::sin(i) * std::sqrt(1 - cos_o * cos_o));
  EXPECT_NEAR(CosDeltaPhi(pair), -from_specular, 1e-9);
}

TEST_F(ZemaxFiles, AnglesAreAboutTheSpecularDirection) {
  const Grid grid;
  const auto brdf = Open("a.txt", TextOf(grid));
  EXPECT_THAT(brdf->Description(),
              HasSubstr("Zemax measurements, isotropic, one channel, 14 meas"));
  const auto samples = brdf->Measurements();
  std::size_t n = 0;
  for (std::size_t i = 0; i < grid.incidences.size(); ++i) {
    for (std::size_t a = 0; a < grid.azimuths.size(); ++a) {
      for (std::size_t r = a == 0 ? 0 : 1; r < grid.radials.size(); ++r, ++n) {
        ExpectAt(samples[n].pair, grid.incidences[i], grid.azimuths[a], grid.radials[r]);
        EXPECT_NEAR(samples[n].value[1], ValueAt(0, 0, i, a, r), 1e-12);
      }
    }
  }
  EXPECT_EQ(n, samples.size());
}

TEST_F(ZemaxFiles, ZerosAreMissing) {
  std::string text = TextOf({});
  const std::size_t value = text.find("0.121");
  text.replace(value, 5, "0.000e+00");
  EXPECT_THAT(Open("a.BSDF", text)->Description(), HasSubstr("13 measurements, 1 unusable ones"));
}

TEST_F(ZemaxFiles, RotationsTurnBothDirections) {
  Grid grid;
  grid.symmetry = "ASYMMETRICAL4D", grid.rotations = {0, 90}, grid.incidences = {50};
  grid.azimuths = {0, 90, 270, 360};
  const auto brdf = Open("a.bsdf", TextOf(grid));
  EXPECT_FALSE(brdf->IsIsotropic());
  const auto samples = brdf->Measurements();
  const std::size_t half = samples.size() / 2;
  ASSERT_EQ(half, 1u + 3 * 2);  // 360 degrees are 0
  for (std::size_t n = 0; n < half; ++n) {
    const auto& [wi, wo] = samples[n].pair;
    ExpectNear(samples[half + n].pair.wi, {-wi.y, wi.x, wi.z});
    ExpectNear(samples[half + n].pair.wo, {-wo.y, wo.x, wo.z});
    EXPECT_NEAR(samples[half + n].value[0] - samples[n].value[0], 0.2, 1e-12);
  }
  grid.symmetry = "PlaneSymmetrical", grid.azimuths = {0, 90};
  const auto mirrored = Open("a.bsdf", TextOf(grid))->Measurements();
  ASSERT_EQ(mirrored.size(), 2u * 2 * 5);
  const auto& [wi, wo] = mirrored[8].pair;
  ExpectNear(mirrored[9].pair.wo, {wo.x, -wo.y, wo.z});  // the plane of incidence is y = 0
  ExpectNear(mirrored[9].pair.wi, wi);
}

TEST_F(ZemaxFiles, TristimulusValuesBecomeRgb) {
  Grid grid;
  grid.content = "XYZ", grid.symmetry = "Asymmetrical";
  const auto brdf = Open("a.bsdf", TextOf(grid));
  EXPECT_EQ(brdf->NumChannels(), 3);
  const Rgb rgb = brdf->Measurements()[1].value;  // X, Y, Z = 0.101, 0.171, 0.241
  EXPECT_NEAR(rgb[0], 3.2406 * 0.101 - 1.5372 * 0.171 - 0.4986 * 0.241, 1e-12);
  EXPECT_NEAR(rgb[1], -0.9689 * 0.101 + 1.8758 * 0.171 + 0.0415 * 0.241, 1e-12);
  EXPECT_NEAR(rgb[2], 0.0557 * 0.101 - 0.2040 * 0.171 + 1.0570 * 0.241, 1e-12);
}

TEST_F(ZemaxFiles, BadFilesAreNamed) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = TextOf({});
    text.replace(text.find(from), from.size(), to);
    return ErrorOfOpening("a.bsdf", text);
  };
  EXPECT_EQ(with("Source", "SOURCE"), "");
  EXPECT_THAT(with("BRDF", "BTDF"),
              HasSubstr("a.bsdf: line 5: ScatterType BTDF: a transmission; only a BRDF is read"));
  EXPECT_THAT(with("PlaneS", "S"),
              HasSubstr("Symmetry Symmetrical is not one of planesymmetrical |"));
  EXPECT_THAT(with("20\t50", "20\t95"),
              HasSubstr("AngleOfIncidence: 95 degrees; must be up to 90"));
  EXPECT_THAT(with("AngleOfIncidence  2", "AngleOfIncidence  0"), HasSubstr("0; must be 1 to"));
  EXPECT_THAT(with("AngleOfIncidence  2", "AngleOfIncidence  3"),
              HasSubstr("'ScatterAzimuth' is not"));
  EXPECT_THAT(with("TIS", "TOS"), HasSubstr("'TOS' where TIS was expected"));
  EXPECT_THAT(with("DataEnd", "0.5"), HasSubstr("'0.5' behind the data of all angles"));
  EXPECT_THAT(with("ScatterAzimuth", "ScatterAzimut"),
              HasSubstr("'ScatterAzimut' is not a keyword"));
}

TEST_F(ZemaxFiles, TruncationsAreRefused) {
  const std::string text = TextOf({});
  for (std::size_t size = 200; size < text.size() - 1; ++size) {
    EXPECT_NE(ErrorOfOpening("a.bsdf", text.substr(0, size)), "") << size;
  }
}

TEST_F(ZemaxFiles, MeasuredFilesAreRead) {
  PBNBRDF_REFERENCE_FILE(folder, "measured/zemax");
  const auto brdf = OpenBrdf(folder + "/AnoBlackEC1onAlum.bsdf");
  // At 50 degrees and R = 50, A = 0 light is scattered along the normal.
  const DirectionPair pair = {FromSpherical(50 * kPi / 180, 1.0), {0, 0, 1}};
  Rgb value;
  brdf->Evaluate({&pair, 1}, {&value, 1});
  EXPECT_NEAR(value[0], 0.01161, 1e-9);
  EXPECT_EQ(brdf->NumChannels(), 1);
  for (const char* name :
       {"AnoBlackNiTEonSteel", "aeroglaze_z307", "radiant_imaging_planesymmetric_brdf"}) {
    const auto samples = OpenBrdf(folder + "/" + name + ".bsdf")->Measurements();
    EXPECT_GT(samples.size(), 600u) << name;
    for (const BrdfSample& sample : samples) EXPECT_NE(sample.value[0], 0.0);
  }
  EXPECT_THAT(ErrorOf([&] { OpenBrdf(folder + "/radiant_imaging_planesymmetric_btdf.bsdf"); }),
              HasSubstr("ScatterType BTDF"));
}

}  // namespace
}  // namespace pbnbrdf
