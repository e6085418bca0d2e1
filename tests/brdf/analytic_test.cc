#include "pbnbrdf/brdf/analytic.h"

#include <set>

#include "brdf/direction_pairs.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/brdf/builtin.h"

namespace pbnbrdf {
namespace {

Rgb ValueAt(const Brdf& brdf, const DirectionPair& pair) {
  Rgb value;
  brdf.Evaluate({&pair, 1}, {&value, 1});
  return value;
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
      for (double albedo : DirectionalAlbedo(*brdf, degrees * kPi / 180, 512, 128)) {
        EXPECT_LT(albedo, 1.001) << material.name << " at " << degrees;
        EXPECT_GT(albedo, 0.01) << material.name << " at " << degrees;
      }
    }
  }
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

}  // namespace
}  // namespace pbnbrdf
