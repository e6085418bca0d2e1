#include "pbnbrdf/brdf/albedo.h"

#include <functional>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/models/analytic.h"

namespace pbnbrdf {
namespace {

constexpr double kDegree = kPi / 180.0;

// Simpson's rule on halves of halves until they agree with the whole.
double Adapt(const std::function<double(double)>& f, double a, double b, double fa, double fm,
             double fb, double tolerance, int depth) {
  const double m = 0.5 * (a + b), flm = f(0.5 * (a + m)), frm = f(0.5 * (m + b));
  const double whole = (b - a) / 6.0 * (fa + 4.0 * fm + fb);
  const double halves = (b - a) / 12.0 * (fa + 4.0 * flm + 2.0 * fm + 4.0 * frm + fb);
  if (depth == 0 || (depth < 16 && std::abs(halves - whole) < 15.0 * tolerance)) {
    return halves + (halves - whole) / 15.0;
  }
  return Adapt(f, a, m, fa, flm, fm, 0.5 * tolerance, depth - 1) +
         Adapt(f, m, b, fm, frm, fb, 0.5 * tolerance, depth - 1);
}

double AdaptiveSimpson(const std::function<double(double)>& f, double a, double b,
                       double tolerance) {
  return Adapt(f, a, b, f(a), f(0.5 * (a + b)), f(b), tolerance, /*depth=*/20);
}

// The albedo of a lobe about the half vector, over theta_h in pieces that start about `width` and
// grow, and over phi_h within. Shares nothing with AlbedoQuadrature but dwo = 4 (wi.h) dwh.
double AdaptiveAlbedo(const Brdf& brdf, double width, double theta_i) {
  constexpr double kTolerance = 1e-7;
  const Vec3 wi = FromSpherical(theta_i, 0.0);
  const auto at = [&](double theta_h, double phi) {
    const Vec3 h = FromSpherical(theta_h, phi);
    const double cos_d = Dot(wi, h);
    const DirectionPair pair = {wi, 2.0 * cos_d * h - wi};
    if (cos_d <= 0.0 || !pair.AboveHorizon()) return 0.0;
    Rgb value;
    brdf.Evaluate({&pair, 1}, {&value, 1});
    return value[0] * pair.wo.z * 4.0 * cos_d * std::sin(theta_h);
  };
  double sum = 0.0;
  for (double from = 0.0, to = 0.5 * width; from < 0.5 * kPi; from = to, to *= 3.0) {
    const double end = std::min(to, 0.5 * kPi);
    const auto ring = [&](double theta_h) {
      const auto on_ring = [&](double phi) { return at(theta_h, phi); };
      const double tolerance = kTolerance / (end - from);  // of a density over theta_h
      return 2.0 * (AdaptiveSimpson(on_ring, 0.0, 0.5 * kPi, tolerance) +
                    AdaptiveSimpson(on_ring, 0.5 * kPi, kPi, tolerance));
    };
    sum += AdaptiveSimpson(ring, from, end, kTolerance);
  }
  return sum;
}

struct Lobe {
  std::string name;
  std::unique_ptr<Brdf> brdf;
  double width;  // radians
};

std::vector<Lobe> Lobes() {
  const Rgb white = {1.0, 1.0, 1.0};
  std::vector<Lobe> lobes;
  lobes.push_back({"lambert", std::make_unique<LambertBrdf>(white), 1.0});
  for (double width : {1.0, 0.3, 0.03, 0.1 * kDegree}) {
    lobes.push_back({"ggx", std::make_unique<GgxBrdf>(Rgb{0.9, 0.9, 0.9}, width), width});
    lobes.push_back({"ward", std::make_unique<WardBrdf>(Rgb{}, white, width), width});
  }
  return lobes;
}

TEST(AlbedoQuadrature, With64x32NodesIsWithin3e4OfAnAdaptiveIntegral) {
  double worst = 0.0;
  for (const Lobe& lobe : Lobes()) {
    for (double degrees : {0.0, 45.0, 80.0, 88.0, 89.5}) {
      const double theta_i = degrees * kDegree;
      const double exact = AdaptiveAlbedo(*lobe.brdf, lobe.width, theta_i);
      const double albedo = DirectionalAlbedo(*lobe.brdf, FromSpherical(theta_i, 0.0), 64, 32)[0];
      EXPECT_NEAR(albedo, exact, 3e-4 * exact)
          << lobe.name << " " << lobe.width << " at " << degrees;
      worst = std::max(worst, std::abs(albedo / exact - 1.0));
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
}

TEST(AlbedoQuadrature, With160x96NodesIsWithin1e6OfAnAdaptiveIntegral) {
  for (const Lobe& lobe : Lobes()) {
    for (double degrees : {0.0, 80.0, 89.5}) {
      const double theta_i = degrees * kDegree;
      const double exact = AdaptiveAlbedo(*lobe.brdf, lobe.width, theta_i);
      EXPECT_NEAR(DirectionalAlbedo(*lobe.brdf, FromSpherical(theta_i, 0.0), 160, 96)[0], exact,
                  1e-6)
          << lobe.name << " " << lobe.width << " at " << degrees;
    }
  }
}

TEST(AlbedoQuadrature, OnMerlRowsIsWithin1e6NextToTheHorizon) {
  const auto quadrature = AlbedoQuadrature::OnMerlRows(6, 700);
  for (const Lobe& lobe : Lobes()) {
    for (double degrees : {89.5, 89.96}) {
      const double theta_i = degrees * kDegree;
      const double exact = AdaptiveAlbedo(*lobe.brdf, lobe.width, theta_i);
      EXPECT_NEAR(DirectionalAlbedo(*lobe.brdf, FromSpherical(theta_i, 0.0), quadrature)[0], exact,
                  1e-6)
          << lobe.name << " " << lobe.width << " at " << degrees;
    }
  }
}

TEST(AlbedoQuadrature, TurnsWithTheIncidentDirection) {
  const GgxBrdf metal({0.8, 0.7, 0.6}, 0.3);
  for (double phi_i : {0.5, 2.0, -3.0}) {
    const Rgb turned = DirectionalAlbedo(metal, FromSpherical(0.9, phi_i));
    const Rgb straight = DirectionalAlbedo(metal, FromSpherical(0.9, 0.0));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(turned[c], straight[c], 1e-12);
  }
}

TEST(AlbedoQuadrature, NodesAreAboveTheHorizonAndCoverTheHemisphere) {
  for (double theta_i : {0.0, 0.7, 1.5, 0.5 * kPi - 1e-6}) {
    double projected_solid_angle = 0.0;
    for (const AlbedoNode& node : AlbedoQuadrature(64, 32).Nodes(FromSpherical(theta_i, 0.0))) {
      EXPECT_TRUE(node.pair.AboveHorizon());
      EXPECT_GT(node.weight, 0.0);
      projected_solid_angle += node.weight;
    }
    EXPECT_NEAR(projected_solid_angle, kPi, 1e-3 * kPi);
  }
}

TEST(GaussLegendre, IntegratesPolynomialsExactly) {
  for (int n : {1, 2, 3, 16, 64, 255}) {
    const GaussLegendre rule(n);
    for (int power = 0; power < 2 * n; power += 1 + n / 4) {
      double sum = 0.0;
      for (int k = 0; k < n; ++k) sum += rule.weights[k] * std::pow(rule.nodes[k], power);
      EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-13) << n << " " << power;
    }
  }
}

// Diffuse, with an albedo that peaks sharply at theta_i = 0.6123.
class PeakedBrdf final : public PointwiseBrdf {
 public:
  static double Albedo(double theta_i) {
    return 1.0 + 0.1 * std::exp(-1000.0 * (theta_i - 0.6123) * (theta_i - 0.6123));
  }
  std::string Description() const override { return "peaked"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    const double f = Albedo(std::acos(pair.wi.z)) / kPi;
    return {f, f, f};
  }
};

TEST(AlbedoProfile, FindsTheMaximumBetweenItsAngles) {
  AlbedoGrid grid;
  grid.angles = 150;
  double largest = 0.0, largest_of_grid = 0.0, solid_angle = 0.0;
  for (const IncidentAlbedo& at : AlbedoProfile(PeakedBrdf(), grid)) {
    EXPECT_NEAR(at.albedo[0], PeakedBrdf::Albedo(at.theta_i), 1e-5);
    largest = std::max(largest, at.albedo[0]);
    if (at.solid_angle > 0.0) largest_of_grid = std::max(largest_of_grid, at.albedo[0]);
    solid_angle += at.solid_angle;
  }
  EXPECT_NEAR(largest, 1.1, 1e-6);
  EXPECT_LT(largest_of_grid, 1.1 - 1e-4);
  EXPECT_NEAR(solid_angle, 2.0 * kPi, 1e-3);
}

// A Lambertian whose single precision is off by a factor.
class RoundedBrdf final : public PointwiseBrdf {
 public:
  RoundedBrdf(double albedo, double factor) : albedo_(albedo), factor_(factor) {}
  std::unique_ptr<Brdf> SinglePrecision() const override {
    return std::make_unique<LambertBrdf>(Rgb{0.0, factor_ * albedo_, 0.0});
  }
  std::string Description() const override { return "rounded"; }

 protected:
  Rgb Value(const DirectionPair&) const override { return {0.0, albedo_ / kPi, 0.0}; }

 private:
  double albedo_, factor_;
};

TEST(AlbedoProfile, SinglePrecisionDecidesNothingThatIsWithinItsRounding) {
  for (double albedo : {0.99999, 1e-4}) {
    const AlbedoGrid grid = {.angles = 10, .refine_above = albedo};
    for (double factor : {0.0, 0.9, 1.0 - 5e-6, 1.0 + 5e-6, 1.2}) {
      const Rgb largest = LargestAlbedos(AlbedoProfile(RoundedBrdf(albedo, factor), grid));
      EXPECT_NEAR(largest[1], albedo, grid.tolerance) << factor;
    }
  }
}

TEST(AlbedoProfile, ReachesTheHorizon) {
  const auto profile = AlbedoProfile(LambertBrdf({0.5, 0.5, 0.5}), AlbedoGrid{});
  double steepest = 0.0;
  for (const IncidentAlbedo& at : profile) steepest = std::max(steepest, at.theta_i);
  EXPECT_LT(0.5 * kPi - steepest, 1e-8);
  EXPECT_LT(steepest, 0.5 * kPi);
}

}  // namespace
}  // namespace pbnbrdf
