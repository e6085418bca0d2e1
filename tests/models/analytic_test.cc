#include "pbnbrdf/models/analytic.h"

#include <set>

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/models/builtin.h"

namespace pbnbrdf {
namespace {

// A material turned about the normal.
class TurnedBrdf final : public PointwiseBrdf {
 public:
  TurnedBrdf(const Brdf& brdf, double phi) : brdf_(brdf), phi_(phi) {}
  bool IsIsotropic() const override { return brdf_.IsIsotropic(); }
  std::string Description() const override { return brdf_.Description(); }

 protected:
  Rgb Value(const DirectionPair& pair) const override { return ValueAt(brdf_, Turned(pair, phi_)); }

 private:
  const Brdf& brdf_;
  double phi_;
};

// Directions in the plane of azimuth phi, on both sides of the normal.
std::vector<DirectionPair> PairsInPlane(double phi) {
  std::vector<DirectionPair> pairs;
  for (double theta_i : {-1.3, -0.4, 0.0, 0.2, 1.5}) {
    for (double theta_o : {-1.4, -0.3, 0.1, 0.5, 1.2}) {
      pairs.push_back({FromSpherical(theta_i, phi), FromSpherical(theta_o, phi)});
    }
  }
  return pairs;
}

TEST(Builtin, AreReciprocalNonNegativeAndFinite) {
  const std::vector<DirectionPair> pairs = HardAndRandomPairs(2000, /*seed=*/3);
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    const std::unique_ptr<Brdf> brdf = material.make();
    for (const DirectionPair& pair : pairs) {
      const Rgb there = ValueAt(*brdf, pair), back = ValueAt(*brdf, Swapped(pair));
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(there[c], 0.0) << material.name;
        ASSERT_LE(there[c], Brdf::kLargestValue) << material.name;
        ASSERT_NEAR(there[c], back[c], 1e-12 * there[c]) << material.name;
      }
    }
  }
}

TEST(Builtin, ConserveEnergy) {
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    const std::unique_ptr<Brdf> brdf = material.make();
    for (double degrees : {0.0, 30.0, 60.0, 80.0, 85.0}) {
      for (double phi : {0.0, 0.5, 1.0, kPi / 2}) {
        if (brdf->IsIsotropic() && phi > 0.0) break;
        const TurnedBrdf turned(*brdf, phi);
        for (double albedo :
             DirectionalAlbedo(turned, FromSpherical(degrees * kPi / 180, 0.0), 512, 128)) {
          EXPECT_LT(albedo, 1.001) << material.name << " at " << degrees << ", " << phi;
          EXPECT_GT(albedo, 0.01) << material.name << " at " << degrees << ", " << phi;
        }
      }
    }
  }
}

TEST(Builtin, AreIsotropicOrNotAsTheySay) {
  int anisotropic = 0;
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    const std::unique_ptr<Brdf> brdf = material.make();
    double largest_change = 0.0;
    for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/5)) {
      const double f = ValueAt(*brdf, pair)[0], turned = ValueAt(*brdf, Turned(pair, 1.0))[0];
      largest_change = std::max(largest_change, std::abs(turned - f) / f);
    }
    if (brdf->IsIsotropic()) {
      EXPECT_LT(largest_change, 1e-7) << material.name;
    } else {
      EXPECT_GT(largest_change, 0.05) << material.name;
      ++anisotropic;
    }
  }
  EXPECT_EQ(anisotropic, 7);
}

TEST(Builtin, ZeroBelowTheHorizon) {
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    EXPECT_EQ(ValueAt(*material.make(), {{0.6, 0.0, -0.8}, {0.0, 0.0, 1.0}}), Rgb{});
  }
}

TEST(Builtin, AtLeastTenWithDifferentNames) {
  std::set<std::string_view> names;
  for (const BuiltinMaterial& material : BuiltinMaterials()) {
    EXPECT_FALSE(material.source.empty());
    EXPECT_NE(MakeBuiltin(material.name), nullptr);
    names.insert(material.name);
  }
  EXPECT_GE(names.size(), 10u);
  EXPECT_EQ(names.size(), BuiltinMaterials().size());
  EXPECT_THAT(ErrorOf([] { MakeBuiltin("gold"); }),
              testing::HasSubstr("builtin:gold is not one of spectralon | "));
}

TEST(Builtin, TheMirrorsLobeIsNarrowerThanAFifthOfADegree) {
  // Full width at half maximum of the reflected lobe at normal incidence.
  const std::unique_ptr<Brdf> mirror = MakeBuiltin("silver-mirror");
  const double peak = ValueAt(*mirror, {{0, 0, 1}, {0, 0, 1}})[0];
  const double half_width = 0.1 * kPi / 180;
  EXPECT_LT(ValueAt(*mirror, {{0, 0, 1}, FromSpherical(half_width, 0.0)})[0], 0.5 * peak);
}

TEST(OrenNayar, IsLambertAtSigmaZero) {
  const OrenNayarBrdf smooth({0.8, 0.4, 0.2}, 0.0);
  for (const DirectionPair& pair : RandomPairs(100, /*seed=*/4)) {
    EXPECT_NEAR(ValueAt(smooth, pair)[1], 0.4 / kPi, 1e-15);
  }
}

TEST(Ggx, NormalIncidencePeakIsThatOfTheFormula) {
  // D(0) = 1 / (pi alpha^2), G = 1, F = f0, over 4 cos^2 = 4.
  const GgxBrdf metal({0.5, 0.5, 0.5}, 0.1);
  EXPECT_NEAR(ValueAt(metal, {{0, 0, 1}, {0, 0, 1}})[0], 0.5 / (4 * kPi * 0.01), 1e-12);
}

// In the plane of x the lobe of widths (a, b) is that of width a, times a / b.
TEST(LobeWidths, InAPlaneTheLobeIsThatOfItsWidthThere) {
  const double a = 0.1, b = 0.3;
  const Rgb grey = {0.5, 0.5, 0.5};
  const WardBrdf ward({}, grey, {a, b}), ward_a({}, grey, a), ward_b({}, grey, b);
  const GgxBrdf ggx(grey, {a, b}), ggx_a(grey, a), ggx_b(grey, b);
  const auto expect_lobe = [](const Brdf& brdf, const Brdf& isotropic, double ratio, double phi) {
    EXPECT_FALSE(brdf.IsIsotropic());
    EXPECT_TRUE(isotropic.IsIsotropic());
    for (const DirectionPair& pair : PairsInPlane(phi)) {
      const double f = ratio * ValueAt(isotropic, pair)[0];
      EXPECT_NEAR(ValueAt(brdf, pair)[0], f, 1e-12 * f);
    }
  };
  expect_lobe(ward, ward_a, a / b, 0.0);
  expect_lobe(ward, ward_b, b / a, kPi / 2);
  expect_lobe(ggx, ggx_a, a / b, 0.0);
  expect_lobe(ggx, ggx_b, b / a, kPi / 2);
}

TEST(LobeWidths, ChangingThemIsAQuarterTurn) {
  const Rgb grey = {0.5, 0.5, 0.5};
  const WardBrdf ward(grey, grey, {0.1, 0.3}), turned_ward(grey, grey, {0.3, 0.1});
  const GgxBrdf ggx(grey, {0.1, 0.3}, grey), turned_ggx(grey, {0.3, 0.1}, grey);
  for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/6)) {
    const DirectionPair turned = Turned(pair, kPi / 2);
    const double f = ValueAt(ward, pair)[0], g = ValueAt(ggx, pair)[0];
    EXPECT_NEAR(ValueAt(turned_ward, turned)[0], f, 1e-12 * f);
    EXPECT_NEAR(ValueAt(turned_ggx, turned)[0], g, 1e-12 * g);
  }
}

TEST(LobeWidths, NearlyEqualOnesGiveNearlyTheIsotropicValues) {
  const Rgb grey = {0.5, 0.5, 0.5};
  const WardBrdf ward(grey, grey, 0.1), nearly_ward(grey, grey, {0.1, 0.1 * (1 + 1e-10)});
  const GgxBrdf ggx(grey, 0.1), nearly_ggx(grey, {0.1, 0.1 * (1 + 1e-10)});
  EXPECT_FALSE(nearly_ward.IsIsotropic());
  EXPECT_FALSE(nearly_ggx.IsIsotropic());
  for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/7)) {
    const double f = ValueAt(ward, pair)[0], g = ValueAt(ggx, pair)[0];
    EXPECT_NEAR(ValueAt(nearly_ward, pair)[0], f, 1e-7 * f);
    EXPECT_NEAR(ValueAt(nearly_ggx, pair)[0], g, 1e-7 * g);
  }
}

TEST(LobeWidths, TheLobesReflectAllThatComesStraightDown) {
  // Narrow ones, of which next to nothing is shadowed; rho_s = f0 = 1: the distribution's integral.
  const Rgb white = {1.0, 1.0, 1.0};
  EXPECT_NEAR(DirectionalAlbedo(WardBrdf({}, white, {0.005, 0.02}), {0.0, 0.0, 1.0}, 512, 512)[0],
              1.0, 1e-3);
  EXPECT_NEAR(DirectionalAlbedo(GgxBrdf(white, {0.002, 0.008}), {0.0, 0.0, 1.0}, 1024, 512)[0], 1.0,
              1e-3);
}

TEST(LobeWidths, DescriptionsNameBoth) {
  EXPECT_THAT(GgxBrdf({}, {0.1, 0.3}).Description(),
              testing::HasSubstr("alpha_x 0.1, alpha_y 0.3"));
  EXPECT_THAT(GgxBrdf({}, 0.1).Description(), testing::HasSubstr(", alpha 0.1,"));
}

}  // namespace
}  // namespace pbnbrdf
