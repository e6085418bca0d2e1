#include "pbnbrdf/sources/in_plane.h"

#include "sources/scattered_fixture.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;
using InPlaneFiles = ScatteredFiles;

const std::string kRows = "20 180 30 0 0.5\n20 180 -40 0 0.25\n60 180 -90 0 1\n20 180 10 0 NA\n";

TEST_F(InPlaneFiles, PhiIsTheAngleFromTheNormal) {
  const double d = kPi / 180;
  for (const char* header :
       {"# about it\n#\n# phi_in   theta_in phi_out theta_out   brdf\n",
        "phi_i theta_i phi_o theta_o brdf\n", "Phi_In,Theta_In,Phi_Out,Theta_Out,BRDF\n"}) {
    std::string rows = kRows;
    if (header[0] == 'P') std::replace(rows.begin(), rows.end(), ' ', ',');
    const auto brdf = Open("a.csv", header + rows);
    EXPECT_THAT(brdf->Description(), HasSubstr("in-plane measurements, isotropic, one channel, 2 "
                                               "measurements, 2 unusable ones left out"));
    const auto samples = brdf->Measurements();
    ExpectNear(samples[0].pair.wi, FromSpherical(20 * d, kPi));
    ExpectNear(samples[0].pair.wo, FromSpherical(30 * d, 0));  // the mirror side
    ExpectNear(samples[1].pair.wo, FromSpherical(40 * d, kPi));
    EXPECT_EQ(samples[1].value, (Rgb{0.25, 0.25, 0.25}));
  }
}

TEST_F(InPlaneFiles, BadFilesAreNamed) {
  const std::string header = "phi_i theta_i phi_o theta_o brdf\n";
  EXPECT_THAT(ErrorOfOpening("a", header + "1 2 3 4\n"),
              HasSubstr("a: line 2: 4 columns, expected 5"));
  EXPECT_THAT(ErrorOfOpening("a", header + "400 0 0 0 1\n"), HasSubstr("line 2: theta_i is 6.98"));
  EXPECT_THAT(ErrorOfOpening("a", header), HasSubstr("no data"));
}

TEST_F(InPlaneFiles, MeasuredScansAreRead) {
  PBNBRDF_REFERENCE_FILE(folder, "measured/lumos");
  const std::pair<const char*, std::size_t> kRowsOf[] = {
      {"A700.csv", 478}, {"aluminum_brdf.csv", 1785}, {"gen2_dialectric_mirror.csv", 597}};
  for (const auto& [name, rows] : kRowsOf) {
    const auto brdf = OpenBrdf(folder + "/" + name);
    EXPECT_EQ(brdf->Measurements().size(), rows) << name;
    EXPECT_TRUE(brdf->IsIsotropic()) << name;
  }
  // Of all rows at 60 degrees the brightest is near the mirror direction.
  const BrdfSample* most = nullptr;
  const auto samples = OpenBrdf(folder + "/A700.csv")->Measurements();
  for (const BrdfSample& s : samples) {
    if (std::abs(s.pair.wi.z - 0.5) < 1e-6 && (!most || s.value[0] > most->value[0])) most = &s;
  }
  ASSERT_NE(most, nullptr);
  EXPECT_NEAR(CosDeltaPhi(most->pair), -1.0, 1e-9);
}

}  // namespace
}  // namespace pbnbrdf
