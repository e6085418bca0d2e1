#include "pbnbrdf/sources/astm.h"

#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using AstmFiles = ScatteredFiles;

std::string Astm(const std::string& vars, const std::string& rows, int count) {
  return StrCat("TITLE a paint\r\nNUM_POINTS ", count, "\r\nVARS ", vars, "\r\n", rows);
}

TEST_F(AstmFiles, VarsNameTheColumns) {
  const std::string angles = "theta_i,phi_i,theta_s,phi_s,", row = "0.5,0,0.4,3,";
  const auto only = [&](const std::string& vars, const std::string& values) {
    const auto samples =
        Samples("a.astm", Astm(angles + vars, row + values + "\r\n" + row + values, 2));
    ExpectNear(samples[0].pair.wo, FromSpherical(0.4, 3));
    return samples[0].value;
  };
  EXPECT_EQ(only("Integrated", "0.5"), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(only("R,G,B", "1,-0.125,3"), (Rgb{1, -0.125, 3}));
  const Rgb white = only("X,Y,Z", "0.9505,1,1.089"),
            flat = only("400nm,550nm,700nm", "0.5,0.5,0.5");
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(white[c], 1.0, 1e-3);
    EXPECT_NEAR(flat[c], 0.5, 1e-6);
  }
  const auto turned = Open("a", Astm("phi_s,theta_s,theta_i,f", "3,0.4,0.5,2\n", 1));
  ExpectNear(turned->Measurements()[0].pair.wi, FromSpherical(0.5, 0));
  EXPECT_THAT(turned->Description(), HasSubstr("ASTM measurements, isotropic, one channel"));
}

TEST_F(AstmFiles, BadFilesAreNamed) {
  const std::string angles = "theta_i,phi_i,theta_s,phi_s";
  const auto error = [&](const std::string& vars, const std::string& rows) {
    return ErrorOfOpening("a.astm", Astm(vars, rows, 1));
  };
  EXPECT_THAT(ErrorOfOpening("a.astm", "1,2\n"),
              HasSubstr("a.astm: not an ASTM file: no line VARS"));
  EXPECT_THAT(error(angles, ""), HasSubstr("line 3: VARS names no values"));
  EXPECT_THAT(error("theta_i,theta_s,f", ""), HasSubstr("VARS must name theta_i, phi_i, theta_s"));
  EXPECT_THAT(error(angles + ",a,b", ""), HasSubstr("values must be one, R,G,B, X,Y,Z or"));
  EXPECT_THAT(error(angles + ",500nm,400nm", ""), HasSubstr("wavelengths must ascend"));
  EXPECT_THAT(error(angles + ",500nm,510nm", ""),
              HasSubstr("a.astm: wavelengths of 500 to 510 nm"));
  EXPECT_THAT(error(angles + ",f", "0,0,0,0\n"), HasSubstr("line 4: 4 columns, expected 5"));
  EXPECT_THAT(error(angles + ",f", "45,0,0,0,1\n"), HasSubstr("line 4: theta_i is 45 radians"));
  EXPECT_THAT(error(angles + ",f", ""), HasSubstr("a.astm: 0 rows, NUM_POINTS says 1"));
}

}  // namespace
}  // namespace pbnbrdf
