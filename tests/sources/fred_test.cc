#include "pbnbrdf/sources/fred.h"

#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using FredFiles = ScatteredFiles;

const std::string kHeader = "type bsdf_data\r\nformat angles=deg bsdf=value scale=1\r\n";

TEST_F(FredFiles, RowsFollowTheirIncidentDirection) {
  const auto brdf = Open("a", kHeader + "10\t0\r\n0\t0\t0.5\r\n20\t30\t0.25\r\n50 0\n60 180 0\n");
  EXPECT_THAT(brdf->Description(), HasSubstr("FRED measurements, isotropic, one channel, 3 meas"));
  const auto samples = brdf->Measurements();
  const double d = kPi / 180;
  ExpectNear(samples[1].pair.wi, FromSpherical(10 * d, 0));
  ExpectNear(samples[1].pair.wo, FromSpherical(20 * d, 210 * d));
  EXPECT_EQ(samples[1].value, (Rgb{0.25, 0.25, 0.25}));
  ExpectNear(samples[2].pair.wo, FromSpherical(60 * d, 0));  // phi_s = 180: back to the light
  EXPECT_EQ(samples[2].value[0], 0.0);
  EXPECT_FALSE(Open("a", kHeader + "10 0\n0 0 1\n10 90\n0 0 1\n")->IsIsotropic());
}

TEST_F(FredFiles, BadFilesAreNamed) {
  const auto error = [&](const std::string& text) { return ErrorOfOpening("a.txt", text); };
  EXPECT_THAT(error("type bsdf_data\nformat angles=rad\n"),
              HasSubstr("line 2: format angles=rad; re"));
  EXPECT_THAT(error(kHeader + "1 2 3\n"), HasSubstr("line 3: a row before the first incident"));
  EXPECT_THAT(error(kHeader + "1 2\n1 2 3 4\n"), HasSubstr("line 4: 4 numbers, expected 3"));
  EXPECT_THAT(error(kHeader + "1 2\n200 2 3\n"), HasSubstr("line 4: theta_o is 3.49"));
  EXPECT_THAT(error(kHeader + "1 2\n"), HasSubstr("no data"));
}

// The instrument's file for FRED and that for Zemax are one measurement: the largest share of the difference is
// that the latter is the mean of both sides and in other directions.
TEST_F(FredFiles, TheMeasuredFileAgreesWithThatForZemax) {
  PBNBRDF_REFERENCE_FILE(fred, "measured/fred/AnoBlackEC1onAlum_fullAz.txt");
  PBNBRDF_REFERENCE_FILE(zemax, "measured/zemax/AnoBlackEC1onAlum.bsdf");
  const auto a = OpenBrdf(fred), b = OpenBrdf(zemax);
  EXPECT_EQ(a->Measurements().size(), 2175u);
  for (int incidence : {10, 30, 50, 70}) {
    const DirectionPair normal = {FromSpherical(incidence * kPi / 180, 0), {0, 0, 1}};
    const DirectionPair mirror = {normal.wi, FromSpherical(incidence * kPi / 180, kPi)};
    for (const DirectionPair& pair : {normal, mirror}) {
      Rgb x, y;
      a->Evaluate({&pair, 1}, {&x, 1});
      b->Evaluate({&pair, 1}, {&y, 1});
      EXPECT_NEAR(x[0], y[0], 0.08 * y[0]) << incidence << " " << pair.wo.z;
    }
  }
}

}  // namespace
}  // namespace pbnbrdf
