#include "pbnbrdf/brdf/scaled.h"

#include <limits>

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"
#include "pbnbrdf/brdf/albedo.h"
#include "pbnbrdf/models/analytic.h"
#include "pbnbrdf/models/builtin.h"
#include "pbnbrdf/sources/merl.h"
#include "pbnbrdf/sources/sgd_file.h"

namespace pbnbrdf {
namespace {

using testing::HasSubstr;

// The largest albedo at angles that LargestAlbedo doesn't look at.
double LargestBetween(const Brdf& brdf) {
  double largest = 0.0;
  for (double degrees = 0.5; degrees < 85.0; degrees += 3.0) {
    for (double a : DirectionalAlbedo(brdf, FromSpherical(degrees * kPi / 180, 0.0)))
      largest = std::max(largest, a);
  }
  return largest;
}

TEST(ScaleToAlbedo, MakesItTheLargestAlbedo) {
  for (const char* name : {"spectralon", "white-sand", "satin-gold", "blue-plastic"}) {
    const auto scaled = ScaleToAlbedo(MakeBuiltin(name), 0.99);
    EXPECT_NEAR(LargestAlbedo(*scaled), 0.99, 1e-12) << name;
    EXPECT_LT(LargestBetween(*scaled), 0.9905) << name;
  }
  EXPECT_NEAR(LargestAlbedo(*ScaleToAlbedo(MakeBuiltin("satin-gold"), 1.5)), 1.5, 1e-12);
}

TEST(ScaleToAlbedo, OfALambertianIsKnown) {
  const auto scaled = ScaleToAlbedo(std::make_unique<LambertBrdf>(Rgb{0.2, 0.5, 0.1}), 0.99);
  EXPECT_NEAR(scaled->factor(), 0.99 / 0.5, 1e-3);
  const DirectionPair pair = {FromSpherical(0.3, 0.0), FromSpherical(0.5, 1.0)};
  EXPECT_NEAR(ValueAt(*scaled, pair)[0], 0.2 * 0.99 / 0.5 / kPi, 1e-3);
}

TEST(ScaleToAlbedo, OfSgdMaterials) {
  PBNBRDF_REFERENCE_FILE(parameters, "sgd/parameters.csv");
  for (const char* name : {"chrome-steel", "pink-felt", "alum-bronze"}) {
    const auto scaled = ScaleToAlbedo(std::make_unique<SgdBrdf>(ReadSgd(parameters, name)), 0.99);
    EXPECT_NEAR(LargestAlbedo(*scaled), 0.99, 1e-12) << name;
  }
}

// A diffuse surface that was measured only at up to 60 degrees from the normal.
class NarrowlyKnownBrdf final : public PointwiseBrdf {
 public:
  bool IsKnown(const DirectionPair& pair) const override {
    return pair.wi.z > 0.5 && pair.wo.z > 0.5;
  }
  std::string Description() const override { return "narrowly known"; }

 protected:
  Rgb Value(const DirectionPair&) const override { return {0.1, 0.2, 0.15}; }
};

TEST(ScaleToAlbedo, OfATableKeepsWhatIsKnown) {
  const MerlBrdf table = MerlBrdf::Tabulate(NarrowlyKnownBrdf());
  const auto scaled = ScaleToAlbedo(std::make_unique<MerlBrdf>(table), 0.99);
  EXPECT_NEAR(LargestAlbedo(*scaled), 0.99, 1e-12);
  int known = 0, unknown = 0;
  for (const DirectionPair& pair : HardAndRandomPairs(1000, /*seed=*/3)) {
    EXPECT_EQ(scaled->IsKnown(pair), table.IsKnown(pair));
    ++(scaled->IsKnown(pair) ? known : unknown);
    const Rgb value = ValueAt(*scaled, pair), source = ValueAt(table, pair);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(value[c], source[c] * scaled->factor());
  }
  EXPECT_GT(known, 100);
  EXPECT_GT(unknown, 100);
  EXPECT_TRUE(scaled->IsIsotropic());
  EXPECT_THAT(scaled->Description(), HasSubstr("MERL table"));
  EXPECT_THAT(scaled->Description(), HasSubstr(StrCat("times ", scaled->factor())));
}

TEST(ScaleToAlbedo, KeepsReciprocity) {
  const auto scaled = ScaleToAlbedo(MakeBuiltin("red-satin-plastic"), 0.99);
  for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/4)) {
    const Rgb there = ValueAt(*scaled, pair), back = ValueAt(*scaled, Swapped(pair));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-12 * there[c]);
  }
}

// Diffuse, brightest where the light comes from the azimuth `bright`: 0.8, and 0.2 opposite to it.
class OneSidedBrdf final : public PointwiseBrdf {
 public:
  explicit OneSidedBrdf(double bright) : bright_(bright) {}
  bool IsIsotropic() const override { return false; }
  std::string Description() const override { return "one-sided"; }

 protected:
  Rgb Value(const DirectionPair& pair) const override {
    const double phi_i = std::atan2(pair.wi.y, pair.wi.x);
    const double f = (0.5 + 0.3 * std::cos(phi_i - bright_)) / kPi;
    return {f, f, f};
  }

 private:
  double bright_;
};

TEST(LargestAlbedo, OfAnAnisotropicSourceIsOverAzimuthsToo) {
  EXPECT_NEAR(LargestAlbedo(OneSidedBrdf(1.25 * kPi)), 0.8, 1e-3);
  EXPECT_FALSE(ScaledBrdf(std::make_unique<OneSidedBrdf>(0.0), 2.0).IsIsotropic());
}

TEST(ScaledBrdf, StaysWithinTheLargestValue) {
  const ScaledBrdf scaled(std::make_unique<LambertBrdf>(Rgb{1, 1, 1}), 1e20);
  const DirectionPair pair = {FromSpherical(0.3, 0.0), FromSpherical(0.5, 1.0)};
  EXPECT_EQ(ValueAt(scaled, pair)[0], Brdf::kLargestValue);
}

class NotANumberBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair>, std::span<Rgb> values) const override {
    for (Rgb& value : values) value = {0.1, NAN, 0.1};
  }
  std::string Description() const override { return "not a number"; }
};

TEST(ScaleToAlbedo, RejectsWhatCannotBeScaled) {
  const auto error = [](std::unique_ptr<Brdf> source, double albedo) {
    return ErrorOf([&] { ScaleToAlbedo(std::move(source), albedo); });
  };
  EXPECT_THAT(
      error(std::make_unique<LambertBrdf>(Rgb{}), 0.99),
      HasSubstr("can't be scaled to an albedo of 0.99: its largest directional albedo is 0"));
  EXPECT_THAT(error(std::make_unique<NotANumberBrdf>(), 0.99),
              HasSubstr("the directional albedo at theta_i = "));
  for (double albedo : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    EXPECT_THAT(error(MakeBuiltin("satin-gold"), albedo), HasSubstr("must be finite and > 0"));
  }
  EXPECT_THAT(ErrorOf([] { ScaledBrdf(MakeBuiltin("satin-gold"), std::nan("")); }),
              HasSubstr("factor = "));
}

}  // namespace
}  // namespace pbnbrdf
