#include "extreme_materials.h"

#include "hard_pairs.h"
#include "pbnbrdf/brdf/half_diff.h"
#include "pbnbrdf/problem/sampling.h"
#include "test_util.h"

namespace pbnbrdf {
namespace {

TEST(ExtremeMaterials, KeepTheBrdfsPromises) {
  const std::vector<DirectionPair> pairs = HardPairs();
  std::vector<Rgb> values(pairs.size());
  for (const ExtremeMaterial& material : ExtremeMaterials()) {
    const auto brdf = material.make();
    brdf->EvaluateUnclipped(pairs, values);
    for (const Rgb& rgb : values) {
      for (double value : rgb) {
        EXPECT_TRUE(value >= 0.0 && value <= Brdf::kLargestValue) << material.name;
      }
    }
  }
}

// The part of random angles at which a material is known, above the horizon or below.
double KnownPart(std::string_view name) {
  const auto brdf = MakeExtremeOrBuiltin(name);
  const std::vector<double> u = RandomNumbers(3 * 40000, 0.0, 1.0, 7);
  int known = 0;
  for (std::size_t n = 0; n < u.size(); n += 3) {
    known += brdf->IsKnown(FromAngles({.theta_h = 0.5 * kPi * u[n],
                                       .theta_d = 0.5 * kPi * u[n + 1],
                                       .phi_d = 2.0 * kPi * u[n + 2]}));
  }
  return 3.0 * known / static_cast<double>(u.size());
}

TEST(ExtremeMaterials, AreKnownWhereTheirNamesSay) {
  EXPECT_NEAR(KnownPart("rare_bins"), 0.01 * KnownPart("black"), 0.003);
  EXPECT_GT(KnownPart("spot"), 0.003);
  EXPECT_LT(KnownPart("spot"), 0.015);
  EXPECT_GT(KnownPart("grazing"), 0.01);
  EXPECT_LT(KnownPart("grazing"), 0.3);
  EXPECT_LT(KnownPart("one_bin"), 1e-4);
  EXPECT_EQ(KnownPart("nowhere"), 0.0);
}

TEST(ExtremeMaterials, NamesOfNoneAreBuiltInOrAnError) {
  EXPECT_EQ(MakeExtremeOrBuiltin("satin-gold")->Description().find("extreme"), std::string::npos);
  EXPECT_NE(ErrorOf([] { MakeExtremeOrBuiltin("unheard-of"); }), "");
}

}  // namespace
}  // namespace pbnbrdf
