#include "pbnbrdf/brdf/half_diff.h"

#include "brdf/direction_pairs.h"

namespace pbnbrdf {
namespace {

double Distance(const DirectionPair& a, const DirectionPair& b) {
  return Length(a.wi - b.wi) + Length(a.wo - b.wo);
}

TEST(HalfDiff, AnglesRoundTrip) {
  for (const DirectionPair& pair : HardAndRandomPairs(10000, /*seed=*/7)) {
    EXPECT_LT(Distance(FromAngles(ToAngles(pair)), pair), 1e-12);
  }
}

TEST(HalfDiff, AgreesWithRotationsOfRusinkiewicz) {
  // d = Ry(-theta_h) Rz(-phi_h) wi, written out.
  for (const DirectionPair& pair : RandomPairs(1000, /*seed=*/8)) {
    const auto [h, d] = ToHalfDiff(pair);
    const double theta = std::atan2(std::hypot(h.x, h.y), h.z), phi = std::atan2(h.y, h.x);
    const Vec3& w = pair.wi;
    const double x = std::cos(phi) * w.x + std::sin(phi) * w.y;
    const double y = -std::sin(phi) * w.x + std::cos(phi) * w.y;
    const Vec3 expected = {std::cos(theta) * x - std::sin(theta) * w.z, y,
                           std::sin(theta) * x + std::cos(theta) * w.z};
    EXPECT_LT(Length(d - expected), 1e-14);
  }
}

TEST(HalfDiff, CosinesAreThoseOfTheDesign) {
  const RusinkiewiczAngles a = {.theta_h = 0.4, .theta_d = 0.6, .phi_d = 1.1, .phi_h = 2.0};
  const DirectionPair pair = FromAngles(a);
  const double plus = std::cos(a.theta_d) * std::cos(a.theta_h);
  const double minus = std::sin(a.theta_d) * std::cos(a.phi_d) * std::sin(a.theta_h);
  EXPECT_NEAR(pair.wi.z, plus - minus, 1e-15);
  EXPECT_NEAR(pair.wo.z, plus + minus, 1e-15);
}

TEST(HalfDiff, SwappingNegatesTheTangentialPartToTheBit) {
  for (const DirectionPair& pair : HardAndRandomPairs(100000, /*seed=*/9)) {
    const HalfDiff there = ToHalfDiff(pair), back = ToHalfDiff(Swapped(pair));
    ASSERT_EQ(there.h.x, back.h.x);
    ASSERT_EQ(there.h.y, back.h.y);
    ASSERT_EQ(there.h.z, back.h.z);
    ASSERT_EQ(there.d.x, -back.d.x);
    ASSERT_EQ(there.d.y, -back.d.y);
    ASSERT_EQ(there.d.z, back.d.z);
  }
}

TEST(HalfDiff, OppositeDirectionsAreDefined) {
  const auto [h, d] = ToHalfDiff({{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}});
  EXPECT_EQ(h.z, 1.0);
  EXPECT_EQ(d.x, 1.0);
  EXPECT_EQ(d.z, 0.0);
}

}  // namespace
}  // namespace pbnbrdf
