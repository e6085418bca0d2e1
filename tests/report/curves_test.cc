#include "report/curves.h"

#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/open_brdf.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(InPlaneCurves, HoldTheValuesOfBothWhereTheySayThatTheyAre) {
  const auto material = OpenBrdf("builtin:satin-gold"), fit = OpenBrdf("builtin:spectralon");
  const std::vector<PlotCurve> curves = InPlaneCurves(*material, *fit);
  ASSERT_EQ(curves.size(), 4u);
  for (const PlotCurve& curve : curves) {
    EXPECT_TRUE(std::is_sorted(curve.x.begin(), curve.x.end()));
    // The lobe's top is on the positive side.
    std::size_t top = 0;
    for (std::size_t n = 0; n < curve.x.size(); ++n) {
      if (curve.material[n][0] > curve.material[top][0]) top = n;
      const DirectionPair pair = {
          FromSpherical(curve.angle * kPi / 180.0, 0.0),
          FromSpherical(std::abs(curve.x[n]) * kPi / 180.0, curve.x[n] > 0.0 ? kPi : 0.0)};
      Rgb value;
      fit->Evaluate({&pair, 1}, {&value, 1});
      EXPECT_NEAR(curve.fit[n][1], value[1], 1e-9);
    }
    EXPECT_GT(curve.x[top], 0.0);
    EXPECT_TRUE(curve.measured_x.empty());  // a formula isn't measured
  }
}

TEST(InPlaneCurves, ShowMeasurementsOfAListThatLieNearTheCurve) {
  TemporaryFolder folder;
  std::string csv = "# isotropic\ntheta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value\n";
  csv += "45,0,30,180,0.7\n45,0,60,0,0.2\n";
  for (int n = 0; n < 40; ++n) csv += StrCat("45,0,", 10 + n, ",90,9\n");  // out of the plane
  for (int n = 0; n < 40; ++n) csv += StrCat("10,0,", n, ",180,0.1\n");
  WriteBytes(folder / "a.csv", csv);
  const auto material = OpenBrdf(folder / "a.csv");
  for (const PlotCurve& curve : InPlaneCurves(*material, *material)) {
    if (std::abs(curve.angle - 45.0) > 0.1) continue;
    ASSERT_EQ(curve.measured_x.size(), 2u);
    EXPECT_NEAR(curve.measured_x[0], -60.0, 1e-6);
    EXPECT_NEAR(curve.measured[0][0], 0.2, 1e-9);
    EXPECT_NEAR(curve.measured_x[1], 30.0, 1e-6);
    EXPECT_NEAR(curve.measured[1][2], 0.7, 1e-9);
    return;
  }
  FAIL() << "no curve at 45 degrees";
}

TEST(InPlaneCurves, TakeTheIncidentAnglesOfAMeasurement) {
  PBNBRDF_REFERENCE_FILE(file, "measured/rgl/chm_mint_rgb.bsdf");
  const auto material = OpenBrdf(file);
  const std::vector<double> angles = material->IncidentAngles();
  for (const PlotCurve& curve : InPlaneCurves(*material, *material)) {
    double distance = 90.0;
    for (const double angle : angles) {
      distance = std::min(distance, std::abs(angle * 180.0 / kPi - curve.angle));
    }
    EXPECT_LT(distance, 1e-9);
    EXPECT_GT(curve.measured_x.size(), 20u);
  }
}

TEST(HalfAngleCurves, EndAtTheHorizon) {
  const auto material = OpenBrdf("builtin:spectralon");
  for (const PlotCurve& curve : HalfAngleCurves(*material, *material)) {
    EXPECT_EQ(curve.x.front(), 0.0);
    EXPECT_GT(curve.x.size(), 5u);
    for (const Rgb& value : curve.fit) EXPECT_NEAR(value[0], 0.99 / kPi, 1e-9);
  }
}

TEST(AlbedoCurves, AreThoseOfADiffuseSurfaceAndEndWhereNothingIsKnown) {
  const auto material = OpenBrdf("builtin:spectralon");
  const AlbedoCurves curves = MeasureAlbedoCurves(*material, *material);
  ASSERT_EQ(curves.theta_i.size(), curves.fit.size());
  for (std::size_t n = 0; n < curves.fit.size(); ++n) {
    EXPECT_NEAR(curves.fit[n][0], 0.99, 1e-3);
    EXPECT_EQ(std::isnan(curves.material[n][0]), curves.theta_i[n] > 85.0);
  }
}

}  // namespace
}  // namespace pbnbrdf
