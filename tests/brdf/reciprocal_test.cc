#include "pbnbrdf/brdf/reciprocal.h"

#include "brdf/direction_pairs.h"
#include "brdf/value_at.h"

namespace pbnbrdf {
namespace {

// f and certainty depend on theta_i alone; nothing is known beyond 80 degrees of it.
class OneSidedBrdf final : public Brdf {
 public:
  void EvaluateUnclipped(std::span<const DirectionPair> pairs,
                         std::span<Rgb> values) const override {
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const double z = pairs[n].wi.z;
      values[n] = {z, 2.0 * z, 1.0 - z};
    }
  }
  bool IsKnown(const DirectionPair& pair) const override {
    return pair.wi.z > std::cos(80 * kDegree);
  }
  double Certainty(const DirectionPair& pair) const override { return 0.1 + 0.9 * pair.wi.z; }
  std::string Description() const override { return "one-sided"; }

 private:
  static constexpr double kDegree = kPi / 180.0;
};

TEST(Reciprocal, IsTheMeanOfBothOrdersWeightedByCertainty) {
  const OneSidedBrdf source;
  const ReciprocalBrdf reciprocal(std::make_unique<OneSidedBrdf>());
  int compared = 0;
  for (const DirectionPair& pair : RandomPairs(500, 1)) {
    if (!pair.AboveHorizon() || !source.IsKnown(pair) || !source.IsKnown(Swapped(pair))) continue;
    const double a = source.Certainty(pair), b = source.Certainty(Swapped(pair));
    const Rgb there = ValueAt(source, pair), back = ValueAt(source, Swapped(pair));
    const Rgb value = ValueAt(reciprocal, pair), swapped = ValueAt(reciprocal, Swapped(pair));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(value[c], (a * there[c] + b * back[c]) / (a + b), 1e-15);
      EXPECT_NEAR(value[c], swapped[c], 1e-15);
    }
    EXPECT_EQ(reciprocal.Certainty(pair), std::max(a, b));
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_TRUE(reciprocal.IsReciprocal());
}

TEST(Reciprocal, TakesTheKnownOrderWhereTheOtherIsNotKnown) {
  const OneSidedBrdf source;
  const ReciprocalBrdf reciprocal(std::make_unique<OneSidedBrdf>());
  const DirectionPair known = {FromSpherical(0.5, 0.0), FromSpherical(1.5, 1.0)};
  for (const DirectionPair& pair : {known, Swapped(known)}) {
    EXPECT_TRUE(reciprocal.IsKnown(pair));
    EXPECT_NEAR(ValueAt(reciprocal, pair)[0], ValueAt(source, known)[0], 1e-8);
  }
  const Vec3 grazing = FromSpherical(1.5, 0.0);
  EXPECT_FALSE(reciprocal.IsKnown({grazing, grazing}));
}

TEST(Reciprocal, LeavesAReciprocalSourceAsItIs) {
  const auto gold = std::make_shared<ReciprocalBrdf>(std::make_unique<OneSidedBrdf>());
  const ReciprocalBrdf twice(gold);
  for (const DirectionPair& pair : RandomPairs(100, 2)) {
    const Rgb once = ValueAt(*gold, pair), again = ValueAt(twice, pair);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(once[c], again[c], 1e-15);
  }
}

}  // namespace
}  // namespace pbnbrdf
