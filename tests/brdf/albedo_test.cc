#include "pbnbrdf/brdf/albedo.h"

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/analytic.h"

namespace pbnbrdf {
namespace {

// The albedo of a microfacet lobe by a grid over the distribution of facet normals: u uniform with
// tan^2 theta_h = alpha^2 u / (1 - u), so that the sharp D drops out. Independent of
// AlbedoQuadrature.
double GgxAlbedo(const Brdf& brdf, double alpha, double theta_i) {
  constexpr int kU = 2000, kPhi = 1000;
  const Vec3 wi = FromSpherical(theta_i, 0.0);
  double sum = 0.0;
  for (int a = 0; a < kU; ++a) {
    const double u = (a + 0.5) / kU;
    const double tan2 = alpha * alpha * u / (1.0 - u);
    const double cos_h = 1.0 / std::sqrt(1.0 + tan2);
    const double slope = alpha * alpha + tan2;
    const double d = alpha * alpha / (kPi * std::pow(cos_h, 4) * slope * slope);
    for (int b = 0; b < kPhi; ++b) {
      const Vec3 h = FromSpherical(std::acos(cos_h), 2.0 * kPi * (b + 0.5) / kPhi);
      const double cos_d = Dot(wi, h);
      const DirectionPair pair = {wi, 2.0 * cos_d * h - wi};
      if (cos_d <= 0.0 || !pair.AboveHorizon()) continue;
      Rgb value;
      brdf.Evaluate({&pair, 1}, {&value, 1});
      sum += value[0] * pair.wo.z * 4.0 * cos_d / (d * cos_h);
    }
  }
  return sum / (double{kU} * kPhi);
}

TEST(DirectionalAlbedo, LambertGivesRhoAtEveryAngle) {
  const LambertBrdf lambert({0.99, 0.5, 0.0});
  for (double degrees : {0.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.5}) {
    const Rgb albedo = DirectionalAlbedo(lambert, degrees * kPi / 180, 64, 32);
    EXPECT_NEAR(albedo[0], 0.99, 1e-3) << degrees;
    EXPECT_NEAR(albedo[1], 0.50, 1e-3) << degrees;
    EXPECT_EQ(albedo[2], 0.0);
  }
}

TEST(DirectionalAlbedo, SharpGgxAgreesWithAnIndependentIntegration) {
  constexpr double kAlpha = 0.01;
  const GgxBrdf metal({0.8, 0.8, 0.8}, kAlpha);
  for (double degrees : {0.0, 30.0, 60.0, 80.0}) {
    const double theta_i = degrees * kPi / 180;
    EXPECT_NEAR(DirectionalAlbedo(metal, theta_i, 64, 32)[0], GgxAlbedo(metal, kAlpha, theta_i),
                1e-3)
        << degrees;
  }
}

TEST(AlbedoQuadrature, NodesAreAboveTheHorizonAndCoverTheHemisphere) {
  for (double theta_i : {0.0, 0.7, 1.5}) {
    double projected_solid_angle = 0.0;
    for (const AlbedoNode& node : AlbedoQuadrature(theta_i, 64, 32)) {
      EXPECT_TRUE(node.pair.AboveHorizon());
      EXPECT_GT(node.weight, 0.0);
      projected_solid_angle += node.weight;
    }
    EXPECT_NEAR(projected_solid_angle, kPi, 1e-3 * kPi);
  }
}

}  // namespace
}  // namespace pbnbrdf
